#include "sim/distance/gjk.h"

#include <limits>

#include "sim/distance/bead_core.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/hull_core.h"

namespace understudy::sim {
namespace {

constexpr double kGap = 1e-9;        // [m], a thousandth of the micrometre that the clearance promises
constexpr int kIterationsMax = 100;  // the worst of 10^6 random pairs took 32

struct Vertex {
  Vec3 difference{0, 0, 0};  // point of the core minus point of the other body
  Vec3 on_other{0, 0, 0};
};

struct Simplex {
  std::array<Vertex, 4> vertex;
  std::array<double, 4> weight{};
  int size = 0;

  const Vertex& at(int i) const { return vertex[static_cast<std::size_t>(i)]; }
  Vec3 nearest() const {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < size; ++i) v += weight[static_cast<std::size_t>(i)] * at(i).difference;
    return v;
  }
  Vec3 on_other() const {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < size; ++i) v += weight[static_cast<std::size_t>(i)] * at(i).on_other;
    return v;
  }
};

const Vec3& farthest(const Triangle& corners, const Vec3& direction) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (corners[i].dot(direction) > corners[best].dot(direction)) best = i;
  }
  return corners[best];
}
Vec3 farthest(const BeadCore& bead, const Vec3& direction) { return bead.farthest(direction); }

// Where to begin: the first direction should already bound most bodies away.
template <typename Core>
Vec3 first_guess(const Core&, const Triangle& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3;
}
template <typename Core>
Vec3 first_guess(const Core& core, const BeadCore& bead) {
  return bead.nearest(core.nearest(bead.middle));
}

Simplex point(const Vertex& a) {
  Simplex s;
  s.vertex[0] = a;
  s.weight[0] = 1;
  s.size = 1;
  return s;
}

Simplex on_segment(const Vertex& a, const Vertex& b) {
  const Vec3 ab = b.difference - a.difference;
  const double t = -a.difference.dot(ab), length2 = ab.squaredNorm();
  if (t <= 0) return point(a);
  if (t >= length2) return point(b);
  Simplex s;
  s.vertex[0] = a;
  s.vertex[1] = b;
  s.weight[0] = 1 - t / length2;
  s.weight[1] = t / length2;
  s.size = 2;
  return s;
}

// Ericson 2005, 5.1.5: the region of the triangle that sees the origin.
Simplex on_triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  const Vec3 ab = b.difference - a.difference, ac = c.difference - a.difference;
  const double d1 = -ab.dot(a.difference), d2 = -ac.dot(a.difference);
  const double d3 = -ab.dot(b.difference), d4 = -ac.dot(b.difference);
  const double d5 = -ab.dot(c.difference), d6 = -ac.dot(c.difference);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (va > 0 && vb > 0 && vc > 0) {
    const double sum = va + vb + vc;
    Simplex s;
    s.vertex[0] = a;
    s.vertex[1] = b;
    s.vertex[2] = c;
    s.weight = {va / sum, vb / sum, vc / sum, 0};
    s.size = 3;
    return s;
  }
  Simplex best = on_segment(a, b);
  for (const Simplex& other : {on_segment(b, c), on_segment(c, a)}) {
    if (other.nearest().squaredNorm() < best.nearest().squaredNorm()) best = other;
  }
  return best;
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c) { return a.cross(b).dot(c); }

// The origin is inside: the weights make a point that both bodies share.
Simplex around_origin(const Simplex& s) {
  const Vec3 &a = s.at(0).difference, &b = s.at(1).difference, &c = s.at(2).difference,
             &d = s.at(3).difference;
  Simplex inside = s;
  inside.weight = {volume(b, c, d), -volume(a, c, d), volume(a, b, d), -volume(a, b, c)};
  const double sum = inside.weight[0] + inside.weight[1] + inside.weight[2] + inside.weight[3];
  for (double& w : inside.weight) w /= sum;
  return inside;
}

// Size 4 in the answer: the origin is inside.
Simplex on_tetrahedron(const Simplex& s) {
  constexpr std::array<std::array<int, 4>, 4> kFaces{
      {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
  Simplex best;
  double best_norm = std::numeric_limits<double>::infinity();
  for (const auto& f : kFaces) {
    const Vec3 &a = s.at(f[0]).difference, &b = s.at(f[1]).difference, &c = s.at(f[2]).difference;
    const Vec3 normal = (b - a).cross(c - a);
    const double opposite = normal.dot(s.at(f[3]).difference - a);
    if (-normal.dot(a) * opposite > 0) continue;  // the origin is on the inner side
    const Simplex face = on_triangle(s.at(f[0]), s.at(f[1]), s.at(f[2]));
    const double norm = face.nearest().squaredNorm();
    if (norm < best_norm) {
      best_norm = norm;
      best = face;
    }
  }
  return best.size > 0 ? best : around_origin(s);
}

Simplex grown_and_reduced(const Simplex& s, const Vertex& w) {
  switch (s.size) {
    case 1:
      return on_segment(s.at(0), w);
    case 2:
      return on_triangle(s.at(0), s.at(1), w);
    default: {
      Simplex four = s;
      four.vertex[3] = w;
      four.size = 4;
      return on_tetrahedron(four);
    }
  }
}

template <typename Core, typename Other>
GjkResult gjk_distance(const Core& core, const Other& other, double enough) {
  const Vec3 start = first_guess(core, other);
  Simplex simplex = point({core.nearest(start) - start, start});
  Vec3 v = simplex.nearest();
  for (int iteration = 1; iteration <= kIterationsMax; ++iteration) {
    const double length = v.norm();
    if (length <= kGap) return {0, simplex.on_other(), iteration};
    const Vec3 b = farthest(other, v);
    const Vertex w{core.farthest(-v) - b, b};
    const double lower = v.dot(w.difference) / length;
    if (length - lower <= kGap || lower >= enough) return {length, simplex.on_other(), iteration};
    const Simplex next = grown_and_reduced(simplex, w);
    if (next.size == 4) return {0, next.on_other(), iteration};
    const Vec3 nearer = next.nearest();
    if (nearer.squaredNorm() >= v.squaredNorm()) return {length, simplex.on_other(), iteration};  // rounding
    simplex = next;
    v = nearer;
  }
  return {v.norm(), simplex.on_other(), kIterationsMax};
}

}  // namespace

template <typename Core>
GjkResult distance_to_triangle(const Core& core, const Triangle& corners, double enough) {
  return gjk_distance(core, corners, enough);
}

template <typename Core>
GjkResult distance_to_bead_core(const Core& core, const BeadCore& bead, double enough) {
  return gjk_distance(core, bead, enough);
}

template GjkResult distance_to_triangle(const PointCore&, const Triangle&, double);
template GjkResult distance_to_triangle(const SegmentCore&, const Triangle&, double);
template GjkResult distance_to_triangle(const FrustumCore&, const Triangle&, double);
template GjkResult distance_to_triangle(const BoxCore&, const Triangle&, double);
template GjkResult distance_to_triangle(const HullCore&, const Triangle&, double);
template GjkResult distance_to_bead_core(const PointCore&, const BeadCore&, double);
template GjkResult distance_to_bead_core(const SegmentCore&, const BeadCore&, double);
template GjkResult distance_to_bead_core(const FrustumCore&, const BeadCore&, double);
template GjkResult distance_to_bead_core(const BoxCore&, const BeadCore&, double);
template GjkResult distance_to_bead_core(const HullCore&, const BeadCore&, double);

}  // namespace understudy::sim
