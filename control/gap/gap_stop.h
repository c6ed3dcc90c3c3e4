// Why the gap controller stops: the answer of an approach and of the control along a path.
#pragma once

namespace understudy::control {

enum class GapStop {
  none,
  no_dot,
  saturated,
  partly_hidden,
  implausible,
  stale_frame,
  too_close,
  too_far,
  no_progress,
  uncertain,
  unreachable,
  port_failed
};
const char* to_string(GapStop s);

}  // namespace understudy::control
