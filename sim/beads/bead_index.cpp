#include "sim/beads/bead_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "sim/beads/bead_shape.h"
#include "sim/beads/bead_tree.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTie = 2e-9;       // [m], twice the accuracy of a distance
constexpr double kRounding = 1e-9;  // [m], by which the next step of a path out must go on
constexpr double kDirected = 1e-9;  // [m]: a shorter difference of places is rounding, and points anywhere
// Of the width: a ball about a bead holds its half length and half width, and rounding.
constexpr double kAround = 0.501;

// The least of the distances offered, and whose they are: of those that tie with it the lowest number, in
// whatever order they come.
class Closest {
 public:
  explicit Closest(double cutoff) : cutoff_(cutoff), limit_(cutoff) {}

  double limit() const { return limit_; }  ///< what is above is of no interest
  void offer(double distance, std::size_t bead) {
    if (!(distance <= limit_)) return;
    tied_.emplace_back(distance, bead);
    if (distance >= least_) return;
    least_ = distance;
    limit_ = std::min(cutoff_, distance + kTie);
    std::erase_if(tied_, [&](const auto& t) { return t.first > limit_; });
  }
  std::optional<std::size_t> winner() const {
    if (tied_.empty()) return std::nullopt;
    return std::min_element(tied_.begin(), tied_.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->second;
  }

 private:
  double cutoff_, limit_;
  double least_ = kInfinity;
  std::vector<std::pair<double, std::size_t>> tied_;
};

double distance_to_box(const BeadTree::Box& box, const Vec3& p) {
  return ((p - box.centre).cwiseAbs() - box.half).cwiseMax(0).norm();
}

struct Ray {
  Vec3 origin, direction;
  Vec3 inverse = direction.cwiseInverse();
};

// Where the ray enters the box; infinite where it misses.
double entry_of_box(const BeadTree::Box& box, const Ray& ray) {
  double first = 0, last = kInfinity;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double from = box.centre[i] - ray.origin[i];
    if (ray.direction[i] == 0) {
      if (std::abs(from) > box.half[i]) return kInfinity;
      continue;
    }
    const double middle = from * ray.inverse[i], half = box.half[i] * std::abs(ray.inverse[i]);
    first = std::max(first, middle - half);
    last = std::min(last, middle + half);
  }
  if (first > last) return kInfinity;
  return first;
}

struct Around {
  Vec3 centre;
  double radius;
};

// Holds the whole bead: its section is no wider than its width, its ends are round.
Around ball_of(const Bead& bead) {
  const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
      to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
  return {0.5 * (from + to), 0.5 * (to - from).norm() + kAround * static_cast<double>(bead.width)};
}

// Whether the ray (of unit direction) passes the ball within `limit`.
bool meets(const Ray& ray, const Around& ball, double limit) {
  const Vec3 to_centre = ball.centre - ray.origin;
  const double along = to_centre.dot(ray.direction);
  return along - ball.radius <= limit && along >= -ball.radius &&
         to_centre.squaredNorm() - along * along <= ball.radius * ball.radius;
}

BeadTree::Bounds around(const Vec3& p, double reach) {
  const Vec3 half = Vec3::Constant(std::max(0.0, reach));
  return {p - half, p + half};
}

BeadTree::Bounds along(const Ray& ray, double reach) {
  constexpr double kBeyondAll = 1e6;  // [m]; infinity times a direction's 0 is no number
  const Vec3 end = ray.origin + std::min(reach, kBeyondAll) * ray.direction;
  return {ray.origin.cwiseMin(end), ray.origin.cwiseMax(end)};
}

template <typename Core>
BeadTree::Bounds bounds_of(const Core& core, const Pose& X_WS) {
  BeadTree::Bounds bounds;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vec3 axis_S = X_WS.linear().row(i).transpose();
    bounds.upper[i] = (X_WS * core.farthest(axis_S))[i];
    bounds.lower[i] = (X_WS * core.farthest(-axis_S))[i];
  }
  return bounds;
}

// A pose as its parts, which are asked for at every box and bead.
struct Placed {
  explicit Placed(const Pose& X_WS) : R(X_WS.linear()), p(X_WS.translation()) {}
  Mat3 R;
  Vec3 p;
};

// How far apart a plane between a core and a box holds them, at most their distance; below 0 where none does.
// First the plane across the shortest line to the box's centre, then, unless that is `enough`, the one across
// the shortest line to the box's point nearest to where the first line began.
template <typename Core>
double bound_of_box(const Core& core, const Placed& at, const BeadTree::Box& box, double enough) {
  const Mat3& R = at.R;
  const Vec3 c = R.transpose() * (box.centre - at.p);
  Vec3 on_core = core.nearest(c);
  double bound = -kInfinity;
  for (Vec3 p = c;;) {
    const Vec3 d = p - on_core;
    const double length = d.norm();
    if (length < kDirected) return bound;
    bound = std::max(bound, (d.dot(c - on_core) - (R * d).cwiseAbs().dot(box.half)) / length);
    if (bound > enough || p != c) return bound;
    const Vec3 from_centre = R * (on_core - c);
    p = c + R.transpose() * from_centre.cwiseMax(-box.half).cwiseMin(box.half);
    on_core = core.nearest(p);
  }
}

// The same of planes across the world's axes, with a box about the core. It is loose where they lie askew,
// but tells at once that no bead under a nozzle reaches far into it.
double bound_along_axes(const BeadTree::Bounds& core, const BeadTree::Box& box) {
  const Vec3 middle = 0.5 * (core.lower + core.upper), half = 0.5 * (core.upper - core.lower);
  return ((box.centre - middle).cwiseAbs() - half - box.half).maxCoeff();
}

// As bound_of_box() for a bead, more loosely about its section; inside the core, by how deep a ball about the
// whole bead can be.
template <typename Core>
double bound_of_bead(const Core& core, const Placed& at, const Bead& bead) {
  const Mat3& R = at.R;
  const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
      to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
  const Vec3 c = R.transpose() * (0.5 * (from + to) - at.p);
  const Vec3 d = c - core.nearest(c);
  const double length = d.norm(), around = 0.5 * static_cast<double>(bead.width);
  if (length < kDirected) return -core.depth(c) - 0.5 * (to - from).norm() - around;
  return length - 0.5 * std::abs((R * d).dot(to - from)) / length - around;
}

void require_finite(bool finite) {
  if (!finite) throw MachineError("beads are asked for at a place that is not finite");
}

}  // namespace

struct BeadIndex::State {
  BeadTree tree;

  template <typename Core>
  std::optional<Near> nearest(const Core& core, double radius, const Pose& X_WS, double cutoff,
                              std::size_t before, std::size_t likely) const;
};

BeadIndex::BeadIndex() : state_(std::make_unique<State>()) {}
BeadIndex::~BeadIndex() = default;
BeadIndex::BeadIndex(BeadIndex&&) noexcept = default;
BeadIndex& BeadIndex::operator=(BeadIndex&&) noexcept = default;

void BeadIndex::add(const Bead& bead) {
  check(bead);
  state_->tree.add(bead);
}
std::size_t BeadIndex::size() const { return state_->tree.size(); }
Bead BeadIndex::bead(std::size_t index) const { return state_->tree.bead(index); }
std::size_t BeadIndex::bytes() const { return sizeof(*this) + state_->tree.bytes(); }

template <typename Core>
std::optional<BeadIndex::Near> BeadIndex::State::nearest(const Core& core, double radius, const Pose& X_WS,
                                                         double cutoff, std::size_t before,
                                                         std::size_t likely) const {
  const Placed at(X_WS);
  Closest closest(cutoff);
  const BeadTree::Bounds here = bounds_of(core, X_WS);
  const auto bound = [&](const BeadTree::Box& box) {
    const double along_axes = bound_along_axes(here, box) - radius;
    if (along_axes > closest.limit()) return along_axes;
    return std::max(along_axes, bound_of_box(core, at, box, closest.limit() + radius) - radius);
  };
  const auto visit = [&](std::size_t index, const Bead& bead) {
    if (index >= before) return;
    if (bound_of_bead(core, at, bead) - radius > closest.limit()) return;
    const Separation s = separation(core, radius, X_WS, core_of(bead), closest.limit() + kTie);
    closest.offer(s.distance, index);
  };
  if (likely < tree.size()) visit(likely, tree.bead(likely));
  const auto region = [&] {
    const Vec3 reach = Vec3::Constant(std::max(0.0, radius + closest.limit()));
    return BeadTree::Bounds{here.lower - reach, here.upper + reach};
  };
  tree.search(
      region, bound, [&] { return closest.limit(); }, visit);
  const auto winner = closest.winner();
  if (!winner) return std::nullopt;
  return Near{separation(core, radius, X_WS, core_of(tree.bead(*winner)), kInfinity), *winner};
}

std::optional<BeadIndex::Near> BeadIndex::nearest(const ConvexSolid& solid, const Pose& X_WS, double cutoff,
                                                  std::size_t before, std::size_t likely) const {
  require_finite(X_WS.matrix().allFinite() && !std::isnan(cutoff));
  return std::visit(
      [&](const auto& core) { return state_->nearest(core, solid.radius, X_WS, cutoff, before, likely); },
      solid.core);
}

std::optional<BeadIndex::Hit> BeadIndex::ray_hit(const Vec3& origin_W, const Vec3& direction_W, double reach,
                                                 std::size_t before, std::size_t likely) const {
  require_finite(origin_W.allFinite() && direction_W.allFinite() && !std::isnan(reach));
  const BeadTree& tree = state_->tree;
  const Ray ray{origin_W, direction_W};
  Closest closest(reach);
  const auto visit = [&](std::size_t index, const Bead& bead) {
    if (index >= before || !meets(ray, ball_of(bead), closest.limit())) return;
    const auto t = entry(core_of(bead), origin_W, direction_W, closest.limit());
    if (t) closest.offer(*t, index);
  };
  if (likely < tree.size()) visit(likely, tree.bead(likely));
  tree.search([&] { return along(ray, closest.limit()); },
              [&](const BeadTree::Box& box) { return entry_of_box(box, ray); },
              [&] { return closest.limit(); }, visit);
  const auto winner = closest.winner();
  if (!winner) return std::nullopt;
  const BeadCore core = core_of(tree.bead(*winner));
  Hit hit;
  hit.bead = *winner;
  hit.distance = *entry(core, origin_W, direction_W, kInfinity);
  hit.place_W = origin_W + hit.distance * direction_W;
  hit.normal_W = normal_at(core, hit.place_W, -direction_W);
  return hit;
}

std::optional<BeadIndex::Hit> BeadIndex::nearest_surface(const Vec3& p_W, double cutoff,
                                                         std::size_t before) const {
  require_finite(p_W.allFinite() && !std::isnan(cutoff));
  const BeadTree& tree = state_->tree;
  Closest closest(cutoff);
  const auto visit = [&](std::size_t index, const Bead& bead) {
    if (index < before) closest.offer(signed_distance(core_of(bead), p_W), index);
  };
  // Inside a box of several beads any depth is possible.
  const auto bound = [&](const BeadTree::Box& box) {
    const double distance = distance_to_box(box, p_W);
    return distance > 0 ? distance : -kInfinity;
  };
  tree.search([&] { return around(p_W, closest.limit()); }, bound, [&] { return closest.limit(); }, visit);
  const auto winner = closest.winner();
  if (!winner) return std::nullopt;
  const BeadCore core = core_of(tree.bead(*winner));
  Hit hit;
  hit.bead = *winner;
  hit.distance = signed_distance(core, p_W);
  hit.normal_W = normal_at(core, p_W, core.up);
  hit.place_W = p_W - hit.distance * hit.normal_W;
  return hit;
}

std::optional<BeadIndex::Hit> BeadIndex::way_out(const Vec3& p_W, const Vec3& direction_W, double slack,
                                                 std::size_t before) const {
  require_finite(p_W.allFinite() && direction_W.allFinite() && !std::isnan(slack));
  const BeadTree& tree = state_->tree;
  std::optional<Hit> out;
  for (double s = 0;;) {
    const Vec3 p = p_W + s * direction_W;
    const bool first = !out;
    Closest farthest(kInfinity);  // of minus the path lengths, so that the longest is the least
    const auto visit = [&](std::size_t index, const Bead& bead) {
      if (index >= before) return;
      const Around ball = ball_of(bead);
      if ((ball.centre - p).squaredNorm() > (ball.radius + slack) * (ball.radius + slack)) return;
      const BeadCore core = core_of(bead);
      const double distance = signed_distance(core, p);
      if (first && slack == 0 ? distance >= 0 : distance > slack) return;
      if (const auto path = leaving(core, p, direction_W)) farthest.offer(-*path, index);
    };
    tree.search([&] { return around(p, slack); },
                [&](const BeadTree::Box& box) { return distance_to_box(box, p); }, [&] { return slack; },
                visit);
    const auto winner = farthest.winner();
    if (!winner) return out;
    const BeadCore core = core_of(tree.bead(*winner));
    const double path = *leaving(core, p, direction_W);
    if (path <= (first && slack == 0 ? 0 : kRounding)) return out;
    s += path;
    out = Hit{s, p_W + s * direction_W, Vec3::Zero(), *winner};
    out->normal_W = normal_at(core, out->place_W, direction_W);
  }
}

}  // namespace understudy::sim
