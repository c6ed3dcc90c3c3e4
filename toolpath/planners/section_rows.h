// Rows of parallel section curves over a surface.
#pragma once

#include <vector>

#include "core/progress.h"
#include "geometry/mesh.h"

namespace understudy::toolpath {

/// Parallel planes, and the limits that clip their sections.
struct SectionRows {
  Vec3 point = Vec3::Zero();    ///< [m], on the middle plane, or between the two middle ones
  Vec3 normal = Vec3::UnitY();  ///< unit, level
  int count = 1;
  double pitch = 0;                   ///< [m], from plane to plane
  double tilt_min = 0, tilt_max = 0;  ///< [rad], as clip_by_tilt takes them
  Progress progress = {};
};

/// section_curve and clip_by_tilt for each plane, along the normal; every second curve runs backwards, so
/// that the tool goes to and fro. Throws InputError as they do, naming the row.
std::vector<std::vector<Vec3>> section_rows(const geometry::Mesh& mesh, const SectionRows& rows);

}  // namespace understudy::toolpath
