// Vectors drawn from a stream, coordinate by coordinate: what the arguments of a constructor leave to the
// compiler, the order of the draws, is x, y, z here.
#pragma once

#include "core/frames.h"
#include "core/random.h"

namespace understudy {

/// Of independent coordinates with mean 0 and standard deviation 1.
inline Vec2 normal_vec2(Random& random) {
  const double x = random.normal(), y = random.normal();
  return {x, y};
}
inline Vec3 normal_vec3(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

/// Of coordinates in [-half, half).
inline Vec2 uniform_vec2(Random& random, double half) {
  const double x = random.uniform(-half, half), y = random.uniform(-half, half);
  return {x, y};
}
inline Vec3 uniform_vec3(Random& random, double half) {
  const double x = random.uniform(-half, half), y = random.uniform(-half, half),
               z = random.uniform(-half, half);
  return {x, y, z};
}

}  // namespace understudy
