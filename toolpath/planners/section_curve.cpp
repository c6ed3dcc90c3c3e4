#include "toolpath/planners/section_curve.h"

#include <algorithm>

#include "core/error.h"
#include "toolpath/planners/mesh_section.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;

// The runs of a line whose triangles face `up`. A closed line is turned to begin outside of them.
std::vector<std::vector<Vec3>> facing_runs(const Mesh& mesh, const SectionLine& line, const Vec3& up) {
  const std::size_t count = line.triangles.size();
  std::vector<bool> faces;
  for (const int t : line.triangles) {
    const auto& [a, b, c] = mesh.triangles()[t];
    const Vec3& p = mesh.vertices()[a];
    const Vec3 n = (mesh.vertices()[b] - p).cross(mesh.vertices()[c] - p);
    faces.push_back(n.dot(up) > 0);
  }
  const bool closed = line.closed();
  const auto outside = std::find(faces.begin(), faces.end(), false);
  const std::size_t shift = closed && outside != faces.end() ? outside - faces.begin() : 0;
  std::vector<std::vector<Vec3>> runs;
  bool inside = false;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = (n + shift) % count;
    if (faces[i] && !inside) runs.push_back({line.points[i]});
    inside = faces[i];
    if (inside && line.points[i + 1] != runs.back().back()) runs.back().push_back(line.points[i + 1]);
  }
  return runs;
}

}  // namespace

std::vector<Vec3> section_curve(const Mesh& mesh, const Vec3& point, const Vec3& normal, const Vec3& up) {
  std::vector<Vec3> longest;
  const std::vector<SectionLine> lines = section_lines(mesh, point, normal.normalized());
  if (lines.empty()) throw InputError("the section plane does not cut the part");
  for (const SectionLine& line : lines)
    for (std::vector<Vec3>& run : facing_runs(mesh, line, up))
      if (polyline_length(run) > polyline_length(longest)) longest = std::move(run);
  if (longest.size() < 2) throw InputError("no part of the section faces up");
  return longest;
}

}  // namespace understudy::toolpath
