// The tree against looking at every bead, while beads are being laid.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "sim/beads/bead_index.h"
#include "sim/beads/bead_shape.h"
#include "tests/property.h"

namespace understudy::sim {
namespace {

using property::real;
using property::whole;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTie = 2e-9;  // [m], what the index may be off, and call alike

/// Where a print of some size goes on: mostly from the last bead's end, as a nozzle does; some blobs, some
/// long strands.
Bead drawn_bead(double size, const std::optional<Bead>& former) {
  const auto floats = [](const Vec3& v) {
    return std::array{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  };
  Bead bead;
  bead.from_W = former && *whole(0, 3) > 0 ? former->to_W : floats(*property::vector(size));
  const int kind = *whole(0, 9);
  bead.to_W = bead.from_W;
  if (kind > 0) {
    const Vec3 along = *property::vector(kind == 1 ? size : 1e-3);
    for (std::size_t k = 0; k < 3; ++k)
      bead.to_W[k] += static_cast<float>(along[static_cast<Eigen::Index>(k)]);
  }
  const Vec3 up = Vec3(0, 0, 1) + *property::vector(*rc::gen::element(0.0, 2.0));
  RC_PRE(up.norm() > 0.01);
  bead.up_W = floats(up.normalized());
  bead.height = static_cast<float>(*real(0.05e-3, 0.6e-3));
  bead.width = bead.height * static_cast<float>(*real(1, 4));
  return bead;
}

ConvexSolid drawn_solid(double scale = 1) {
  const double radius = scale * *real(0.05e-3, 1e-3), length = scale * *real(0.1e-3, 3e-3);
  switch (*whole(0, 3)) {
    case 0:
      return {PointCore{}, radius};
    case 1:
      return {SegmentCore{length / 2}, radius};
    case 2:
      return {FrustumCore{radius / 2, radius, 0, length}, 0};
    default:
      return {BoxCore{Vec3(radius, length / 2, *real(0.05e-3, 1e-3))}, 0};
  }
}

/// Of one question: the distance to each bead, infinite where it has no answer.
struct BruteForce {
  std::vector<double> solid, point, ray;
};

BruteForce look_at_all(const std::vector<Bead>& beads, std::size_t before, const ConvexSolid& solid,
                       const Pose& X) {
  BruteForce all;
  for (std::size_t i = 0; i < before; ++i) {
    const BeadCore core = core_of(beads[i]);
    all.solid.push_back(std::visit(
        [&](const auto& c) { return separation(c, solid.radius, X, core, kInfinity).distance; }, solid.core));
    all.point.push_back(signed_distance(core, X.translation()));
    all.ray.push_back(entry(core, X.translation(), X.linear().col(2), kInfinity).value_or(kInfinity));
  }
  return all;
}

/// The answer is the least of `distances` where that is within `cutoff`, of the first bead that ties.
void same(const std::vector<double>& distances, double cutoff, bool found, double distance,
          std::size_t bead) {
  double least = kInfinity;
  for (const double distance_to_one : distances) least = std::min(least, distance_to_one);
  RC_LOG() << "least " << least << ", cutoff " << cutoff << "\n";
  RC_PRE(!(std::abs(least - cutoff) <= kTie));
  RC_ASSERT(found == (least <= cutoff && std::isfinite(least)));
  if (!found) return;
  RC_ASSERT(std::abs(distance - least) <= kTie);
  const auto first =
      std::find_if(distances.begin(), distances.end(), [&](double d) { return d <= least + kTie; });
  RC_ASSERT(bead == static_cast<std::size_t>(first - distances.begin()));
}

/// The index' answers about the first `before` beads against those of every single one.
void compare(const BeadIndex& index, const std::vector<Bead>& beads, const ConvexSolid& solid, const Pose& X,
             double cutoff, std::size_t before) {
  // What is looked at first may be far off, not asked about, or not there.
  const auto likely = static_cast<std::size_t>(*whole(0, 240));
  RC_LOG() << "beads " << beads.size() << ", before " << before << ", likely " << likely << "\n";
  const BruteForce all = look_at_all(beads, std::min(before, beads.size()), solid, X);
  const auto near = index.nearest(solid, X, cutoff, before, likely);
  same(all.solid, cutoff, near.has_value(), near ? near->separation.distance : 0, near ? near->bead : 0);
  const auto surface = index.nearest_surface(X.translation(), cutoff, before);
  same(all.point, cutoff, surface.has_value(), surface ? surface->distance : 0, surface ? surface->bead : 0);
  const auto hit = index.ray_hit(X.translation(), X.linear().col(2), cutoff, before, likely);
  same(all.ray, cutoff, hit.has_value(), hit ? hit->distance : 0, hit ? hit->bead : 0);
}

TEST(BeadIndexProperties, AnswersAsLookingAtEveryBeadDoesWhileBeadsAreLaid) {
  property::check({200, 60}, [] {
    const double size = *property::magnitude(1e-3, 0.3);  // [m], of the print
    BeadIndex index;
    std::vector<Bead> beads;
    for (int turns = *whole(1, 8); turns > 0; --turns) {
      for (int more = *rc::gen::inRange(0, 30); more > 0; --more) {
        beads.push_back(drawn_bead(size, beads.empty() ? std::nullopt : std::optional(beads.back())));
        index.add(beads.back());
      }
      RC_ASSERT(index.size() == beads.size());
      const ConvexSolid solid = drawn_solid();
      // Beside a bead as often as anywhere.
      Vec3 place = *property::vector(size);
      if (!beads.empty() && *whole(0, 1) == 0) {
        const Bead& beside = beads[static_cast<std::size_t>(*whole(0, static_cast<int>(beads.size()) - 1))];
        place = Vec3(beside.from_W[0], beside.from_W[1], beside.from_W[2]) + *property::vector(1e-3);
      }
      const Pose X = make_pose(exp_rotation(*property::vector(1.8)), place);
      const std::size_t before =
          *whole(0, 1) == 0 ? BeadIndex::kAll : static_cast<std::size_t>(*whole(0, 240));
      const double cutoff = *whole(0, 1) == 0 ? kInfinity : *property::magnitude(0.1e-3, 0.3);
      compare(index, beads, solid, X, cutoff, before);
    }
  });
}

// Thin beads all through a body: none is deeper by its own radius than by where its core lies.
TEST(BeadIndexProperties, OfBeadsInsideABodyTheDeepestIsFound) {
  property::check({1500, 40}, [] {
    BeadIndex index;
    std::vector<Bead> beads;
    for (int n = *rc::gen::inRange(2, 20); n > 0; --n) {
      Bead bead = drawn_bead(1.5e-3, std::nullopt);
      bead.height = 0.1e-3F;
      bead.width = bead.height * static_cast<float>(*real(1, 10));
      index.add(bead);
      beads.push_back(bead);
    }
    const Pose X = make_pose(exp_rotation(*property::vector(1.8)), *property::vector(1e-3));
    compare(index, beads, drawn_solid(3), X, kInfinity, BeadIndex::kAll);
  });
}

// What is added later changes no answer about what lay there before.
TEST(BeadIndexProperties, BeadsThatFollowDoNotChangeAnswersAboutThoseBefore) {
  property::check({300, 80}, [] {
    BeadIndex index;
    std::optional<Bead> last;
    for (int n = *rc::gen::inRange(1, 60); n > 0; --n) index.add(*(last = drawn_bead(0.02, last)));
    const std::size_t before = index.size();
    const Vec3 place = *property::vector(0.02);
    const Pose X = make_pose(exp_rotation(*property::vector(1.8)), *property::vector(0.02));
    const ConvexSolid solid = drawn_solid();
    const auto then = index.nearest_surface(place, kInfinity);
    const auto near_then = index.nearest(solid, X, kInfinity);
    const auto hit_then = index.ray_hit(place, X.linear().col(2), kInfinity);
    const Bead kept = index.bead(before - 1);
    for (int n = *rc::gen::inRange(1, 60); n > 0; --n) index.add(*(last = drawn_bead(0.1, last)));
    const auto now = index.nearest_surface(place, kInfinity, before);
    RC_ASSERT(now->distance == then->distance);
    RC_ASSERT(now->bead == then->bead);
    const auto near_now = index.nearest(solid, X, kInfinity, before);
    RC_ASSERT(near_now->bead == near_then->bead);
    RC_ASSERT(near_now->separation.distance == near_then->separation.distance);
    const auto hit_now = index.ray_hit(place, X.linear().col(2), kInfinity, before);
    RC_ASSERT(hit_now.has_value() == hit_then.has_value());
    if (hit_then) RC_ASSERT(hit_now->bead == hit_then->bead && hit_now->distance == hit_then->distance);
    RC_ASSERT(index.bead(before - 1).from_W == kept.from_W && index.bead(before - 1).to_W == kept.to_W);
    RC_ASSERT(index.nearest_surface(place, kInfinity)->distance <= then->distance);
  });
}

}  // namespace
}  // namespace understudy::sim
