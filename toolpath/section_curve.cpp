#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "toolpath/polyline.h"
#include "toolpath/surface_planner.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;

// Walks from triangle to triangle along the plane. A vertex on the plane counts as above it, so that every
// triangle is either crossed through exactly two of its edges or not at all.
class Slicer {
 public:
  Slicer(const Mesh& mesh, const Vec3& point, const Vec3& normal)
      : mesh_(mesh), seen_(mesh.triangles().size()) {
    heights_.reserve(mesh.vertices().size());
    for (const Vec3& v : mesh.vertices()) heights_.push_back(normal.dot(v - point));
  }

  // One section line: its points, and between each two of them the triangle that they cross.
  struct Line {
    std::vector<Vec3> points;
    std::vector<int> triangles;
  };

  std::vector<Line> lines() {
    std::vector<Line> result;
    const int count = static_cast<int>(mesh_.triangles().size());
    // Open lines first, from the border where they begin; what is left runs round.
    for (int t = 0; t < count; ++t)
      if (crossed(t) && neighbour(t, entry(t)) < 0) result.push_back(follow(t));
    for (int t = 0; t < count; ++t)
      if (crossed(t)) result.push_back(follow(t));
    return result;
  }

 private:
  std::size_t corner(int t, int k) const {
    return static_cast<std::size_t>(
        mesh_.triangles()[static_cast<std::size_t>(t)][static_cast<std::size_t>(k % 3)]);
  }
  bool above(int t, int k) const { return heights_[corner(t, k)] >= 0; }
  bool crossed(int t) const {
    return !seen_[static_cast<std::size_t>(t)] && (above(t, 0) != above(t, 1) || above(t, 1) != above(t, 2));
  }
  int neighbour(int t, int side) const {
    return mesh_.neighbours()[static_cast<std::size_t>(t)][static_cast<std::size_t>(side)];
  }
  // Side that runs from above to below, through which the line comes in, and the other.
  int entry(int t) const { return side_where(t, true); }
  int exit(int t) const { return side_where(t, false); }
  int side_where(int t, bool falling) const {
    for (int k = 0; k < 3; ++k)
      if (above(t, k) == falling && above(t, k + 1) != falling) return k;
    return -1;
  }
  Vec3 crossing(int t, int side) const {
    // Always from the upper to the lower end, so that both triangles of an edge compute the same point.
    std::size_t high = corner(t, side), low = corner(t, side + 1);
    if (heights_[high] < heights_[low]) std::swap(high, low);
    const double s = heights_[high] / (heights_[high] - heights_[low]);
    return mesh_.vertices()[high] + s * (mesh_.vertices()[low] - mesh_.vertices()[high]);
  }

  Line follow(int t) {
    Line line;
    line.points.push_back(crossing(t, entry(t)));
    while (t >= 0 && crossed(t)) {
      seen_[static_cast<std::size_t>(t)] = true;
      line.points.push_back(crossing(t, exit(t)));
      line.triangles.push_back(t);
      t = neighbour(t, exit(t));
    }
    return line;
  }

  const Mesh& mesh_;
  std::vector<double> heights_;
  std::vector<bool> seen_;
};

// The runs of a line whose triangles face `up`. A closed line is turned to begin outside of them.
std::vector<std::vector<Vec3>> facing_runs(const Mesh& mesh, const Slicer::Line& line, const Vec3& up) {
  const std::size_t count = line.triangles.size();
  std::vector<bool> faces;
  for (const int t : line.triangles) {
    const auto& [a, b, c] = mesh.triangles()[static_cast<std::size_t>(t)];
    const Vec3& p = mesh.vertices()[static_cast<std::size_t>(a)];
    const Vec3 n = (mesh.vertices()[static_cast<std::size_t>(b)] - p)
                       .cross(mesh.vertices()[static_cast<std::size_t>(c)] - p);
    faces.push_back(n.dot(up) > 0);
  }
  const bool closed = line.points.front() == line.points.back();
  const auto outside = std::find(faces.begin(), faces.end(), false);
  const std::size_t shift =
      closed && outside != faces.end() ? static_cast<std::size_t>(outside - faces.begin()) : 0;
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
  const std::vector<Slicer::Line> lines = Slicer(mesh, point, normal.normalized()).lines();
  if (lines.empty()) throw InputError("the section plane does not cut the part");
  for (const Slicer::Line& line : lines)
    for (std::vector<Vec3>& run : facing_runs(mesh, line, up))
      if (polyline_length(run) > polyline_length(longest)) longest = std::move(run);
  if (longest.size() < 2) throw InputError("no part of the section faces up");
  return longest;
}

}  // namespace understudy::toolpath
