#include "toolpath/planners/mesh_section.h"

#include <utility>

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

  std::vector<SectionLine> lines() {
    std::vector<SectionLine> result;
    const int count = static_cast<int>(mesh_.triangles().size());
    // Open lines first, from the border where they begin; what is left runs round.
    for (int t = 0; t < count; ++t)
      if (crossed(t) && neighbour(t, entry(t)) < 0) result.push_back(follow(t));
    for (int t = 0; t < count; ++t)
      if (crossed(t)) result.push_back(follow(t));
    return result;
  }

 private:
  int corner(int t, int k) const { return mesh_.triangles()[t][k % 3]; }
  bool above(int t, int k) const { return heights_[corner(t, k)] >= 0; }
  bool crossed(int t) const {
    return !seen_[t] && (above(t, 0) != above(t, 1) || above(t, 1) != above(t, 2));
  }
  int neighbour(int t, int side) const { return mesh_.neighbours()[t][side]; }
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
    int high = corner(t, side), low = corner(t, side + 1);
    if (heights_[high] < heights_[low]) std::swap(high, low);
    const double s = heights_[high] / (heights_[high] - heights_[low]);
    return mesh_.vertices()[high] + s * (mesh_.vertices()[low] - mesh_.vertices()[high]);
  }

  SectionLine follow(int t) {
    SectionLine line;
    line.points.push_back(crossing(t, entry(t)));
    while (t >= 0 && crossed(t)) {
      seen_[t] = true;
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

}  // namespace

std::vector<SectionLine> section_lines(const Mesh& mesh, const Vec3& point, const Vec3& normal) {
  return Slicer(mesh, point, normal).lines();
}

}  // namespace understudy::toolpath
