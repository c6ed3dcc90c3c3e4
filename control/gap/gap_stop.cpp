#include "control/gap/gap_stop.h"

namespace understudy::control {

const char* to_string(GapStop s) {
  switch (s) {
    case GapStop::none:
      return "aim reached";
    case GapStop::no_dot:
      return "no dot";
    case GapStop::saturated:
      return "dot saturated";
    case GapStop::partly_hidden:
      return "dot partly hidden";
    case GapStop::implausible:
      return "implausible reading";
    case GapStop::stale_frame:
      return "stale frame";
    case GapStop::too_close:
      return "too close";
    case GapStop::too_far:
      return "too far";
    case GapStop::no_progress:
      return "no progress";
    case GapStop::uncertain:
      return "sensor too uncertain";
    case GapStop::unreachable:
      return "out of reach";
    case GapStop::port_failed:
      return "machine failed";
  }
  return "unknown";
}

}  // namespace understudy::control
