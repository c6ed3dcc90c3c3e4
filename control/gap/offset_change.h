// A shift of the programmed poses that the gap controller has decided, for those who watch a print.
#pragma once

#include "core/frames.h"

namespace understudy::control {

/// From `time` on, every programmed pose is shifted by `offset_W`.
struct OffsetChange {
  double time = 0;
  int line = 0;
  Vec3 offset_W{0, 0, 0};
  bool gradual = false;  ///< the shift goes straight from the one before, whose time it had, to this
};

}  // namespace understudy::control
