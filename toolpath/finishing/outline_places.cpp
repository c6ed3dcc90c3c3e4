#include "toolpath/finishing/outline_places.h"

#include <algorithm>
#include <cmath>

#include "toolpath/finishing/surface_fit.h"
#include "toolpath/planners/mesh_section.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

double angle_of(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Without points that repeat, and without the last, which is the first.
std::vector<Vec3> ring_of(const SectionLine& line) {
  constexpr double kSame = 1e-9;  // [m]
  std::vector<Vec3> ring;
  for (const Vec3& p : line.points)
    if (ring.empty() || (p - ring.back()).norm() > kSame) ring.push_back(p);
  while (ring.size() > 1 && (ring.front() - ring.back()).norm() <= kSame) ring.pop_back();
  return ring;
}

/// Pieces from corner to corner; of a round line, one from its first point to itself.
std::vector<std::vector<Vec3>> pieces_of(std::vector<Vec3> ring) {
  const std::size_t n = ring.size();
  std::vector<bool> corner(n);
  for (std::size_t i = 0; i < n; ++i)
    corner[i] = angle_of(ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]) > kCornerTurn;
  const auto first = std::find(corner.begin(), corner.end(), true);
  const auto begin = first == corner.end() ? 0 : static_cast<std::size_t>(first - corner.begin());
  std::vector<std::vector<Vec3>> pieces;
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t k = (begin + i) % n;
    if (!pieces.empty()) pieces.back().push_back(ring[k]);
    if (i < n && (i == 0 || corner[k])) pieces.push_back({ring[k]});
  }
  return pieces;
}

class Walk {
 public:
  Walk(const geometry::Mesh& part, double step, double reach) : part_(part), step_(step), reach_(reach) {}

  Outline along(const std::vector<std::vector<Vec3>>& pieces) {
    for (const auto& piece : pieces) add_piece(piece);
    if (outline_.places.empty()) return outline_;
    if (outline_.places.size() > 1 && same(outline_.places.front(), outline_.places.back()))
      outline_.places.pop_back();
    turn_to(outline_.places.front().normal);
    return std::move(outline_);
  }

 private:
  void add_piece(const std::vector<Vec3>& piece) {
    double length = 0;
    for (std::size_t i = 1; i < piece.size(); ++i) length += (piece[i] - piece[i - 1]).norm();
    const int parts = step_count(length, step_);
    const double spacing = length / parts;
    std::size_t k = 1;
    double before = 0;  // from the piece's beginning to point k - 1
    for (int n = 0; n <= parts; ++n) {
      const double s = n * spacing;
      while (k + 1 < piece.size() && before + (piece[k] - piece[k - 1]).norm() < s) {
        before += (piece[k] - piece[k - 1]).norm();
        ++k;
      }
      const Vec3 way = (piece[k] - piece[k - 1]).normalized();
      const Vec3 p = n == parts ? piece.back() : Vec3(piece[k - 1] + (s - before) * way);
      // At an edge the surface is the one that the piece runs on.
      const double inwards = std::min(kInwards, spacing / 4) * (n == 0 ? 1 : n == parts ? -1 : 0);
      add(p, part_.nearest(p + inwards * way));
    }
  }

  void add(const Vec3& p, const geometry::SurfacePoint& at) {
    const Vec3 normal = fitted_normal(part_, at, reach_);
    outline_.deviation = std::max(outline_.deviation, angle_of(normal, at.normal));
    turn_to(normal);
    if (outline_.places.empty() || !same(outline_.places.back(), {p, normal}))
      outline_.places.push_back({p, normal});
  }

  static bool same(const OutlinePlace& a, const OutlinePlace& b) {
    constexpr double kRounding = 1e-9;  // [m], [rad]
    return (a.position - b.position).norm() < kRounding && angle_of(a.normal, b.normal) < kRounding;
  }

  /// Round an edge in place, where the normal leaps.
  void turn_to(const Vec3& normal) {
    if (outline_.places.empty()) return;
    const OutlinePlace last = outline_.places.back();
    const double turn = angle_of(last.normal, normal);
    const int parts = static_cast<int>(std::ceil(turn / kCornerTurn));
    const Vec3 axis = last.normal.cross(normal).normalized();
    for (int n = 1; n < parts; ++n)
      outline_.places.push_back({last.position, exp_rotation(turn * n / parts * axis) * last.normal});
  }

  static constexpr double kInwards = 10 * kMicrometre;
  const geometry::Mesh& part_;
  double step_, reach_;
  Outline outline_;
};

}  // namespace

std::vector<Outline> outlines_at(const geometry::Mesh& part, double height, double step, double fit_reach) {
  std::vector<Outline> outlines;
  for (const SectionLine& line : section_lines(part, Vec3(0, 0, height), Vec3::UnitZ())) {
    if (!line.closed()) continue;
    std::vector<Vec3> ring = ring_of(line);
    if (ring.size() < 3) continue;
    Outline outline = Walk(part, step, fit_reach).along(pieces_of(std::move(ring)));
    if (outline.places.size() >= 3) outlines.push_back(std::move(outline));
  }
  return outlines;
}

}  // namespace understudy::toolpath
