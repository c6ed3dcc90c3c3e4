// What an end mill did to a part, in figures.
#pragma once

#include "core/frames.h"

namespace understudy::sim {

/// Heights along the normals of the finished part. The surface that counts is what the program would mill on
/// a machine without errors: where the commanded poses take material.
struct RemovalSummary {
  double spacing = 0;            ///< [m], of the samples
  double finished_fraction = 0;  ///< of the part's surface (without its foot): what counts
  /// [m], material above the finished surface, over what counts.
  double left_over_mean = 0, left_over_p95 = 0, left_over_max = 0;
  double planned_left_over_p95 = 0, planned_left_over_max = 0;  ///< the same without the machine's errors
  double gouge = 0;          ///< [m], deepest below the finished surface, of all of the part
  double planned_gouge = 0;  ///< [m], without the machine's errors
  Vec3 gouge_place_W{0, 0, 0};
  int gouge_line = 0;
  double volume = 0;  ///< [m^3], taken: heights times area of the finished surface
};

}  // namespace understudy::sim
