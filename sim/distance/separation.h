// The answer of a distance query.
#pragma once

#include "core/frames.h"

namespace understudy::sim {

struct Separation {
  double distance = 0;    ///< [m]; 0 or less: they overlap
  Vec3 place_W{0, 0, 0};  ///< nearest point on the obstacle; where they overlap, a point of the overlap
};

}  // namespace understudy::sim
