// The bead index against FCL, one shape a bead, and against itself without the tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <numbers>

#include "core/random.h"
#include "sim/beads/bead_index.h"
#include "sim/beads/bead_shape.h"
#include "sim/collision/fcl_world.h"
#include "tests/sim/beads/beads_for_tests.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// FCL's round bodies are polytopes 0.25 um off (fcl_world.h), a blob's disc as well.
constexpr double kPolytopes = 0.6e-6;  // [m]
// Its iterations now and then end early, at too long a distance (docs/reference.md#rendering-and-collision:
// within 0.003 mm).
constexpr double kEndsEarly = 3e-6;  // [m]

// What a bead is rounded around, as FCL has it.
class FclBead {
 public:
  FclBead(FclWorld& world, const Bead& bead) : radius_(0.5 * static_cast<double>(bead.height)) {
    const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
        to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
    const Vec3 up = Vec3(bead.up_W[0], bead.up_W[1], bead.up_W[2]).normalized();
    const double length = (to - from).norm();
    const double flat = static_cast<double>(bead.width) - static_cast<double>(bead.height);
    X_.translation() = 0.5 * (from + to);
    constexpr double kThin = 1e-9;  // [m]: FCL wants bodies
    if (length == 0 && flat == 0) {
      shape_ = world.add({"", geometry::Sphere{0}, X_});
    } else if (length == 0) {
      X_.linear() = shortest_arc_from_z(up).toRotationMatrix();
      shape_ = world.add({"", geometry::Cylinder{flat / 2, kThin}, X_});
    } else {
      const Vec3 x = (to - from) / length, y = up.cross(x).normalized();
      X_.linear() << x, y, x.cross(y);
      if (flat == 0) {
        shape_ = world.add({"", geometry::Capsule{0, length}, X_});
        X_.linear() << y, x.cross(y), x;
      } else {
        shape_ = world.add({"", geometry::Box{Vec3(length, flat, kThin)}, X_});
      }
    }
  }
  double distance(const FclWorld& world, int solid, const Pose& X_WS) const {
    return world.distance(solid, X_WS, shape_, X_).distance - radius_;
  }

 private:
  int shape_ = -1;
  Pose X_ = Pose::Identity();
  double radius_ = 0;
};

struct Tally {
  int cases = 0, contacts = 0, misses = 0, false_alarms = 0, in_margin = 0;
};

// A scene of a few beads and many solids near them. Contact: nearest() at or below a level; a miss or a false
// alarm is one that FCL denies by more than its own error.
void run_scene(std::uint64_t seed, int solids, Tally& tally) {
  Random random(seed, "bead oracle");
  const std::vector<Bead> beads = test::random_beads(random, 10, 2e-3);
  BeadIndex index;
  FclWorld world;
  std::vector<FclBead> oracle;
  for (const Bead& bead : beads) {
    index.add(bead);
    oracle.emplace_back(world, bead);
  }
  for (int k = 0; k < solids; ++k) {
    const geometry::Shape shape = test::random_shape(random);
    const Vec3 turn = test::random_vector(random, 2);
    const Pose X = make_pose(exp_rotation(turn), test::random_vector(random, 2.8e-3));
    // Contact by touching, by a working gap, and well inside what a bead's roundness covers.
    const double level = random.uniform() < 0.5 ? 0 : random.uniform(-0.02e-3, 0.3e-3);
    const int solid = world.add(shape);
    double least = kInfinity;
    for (const FclBead& bead : oracle) least = std::min(least, bead.distance(world, solid, X));
    const auto near = index.nearest(*convex_solid(shape), X, 2e-3);
    const double found = near ? near->separation.distance : kInfinity;
    ++tally.cases;
    tally.contacts += least <= level ? 1 : 0;
    if ((found <= level) == (least <= level)) {
      // Overlapping cores have no distance in FCL.
      if (least > 0 && least < 2e-3 - kEndsEarly) {
        EXPECT_TRUE(found <= least + kPolytopes && found >= least - kEndsEarly)
            << found << " instead of " << least << ", seed " << seed << ", case " << k << '\n'
            << test::paste(beads) << test::paste(shape) << test::paste(X);
      }
      continue;
    }
    const bool decided = least <= level ? least <= level - kPolytopes : least > level + kEndsEarly;
    int& count = !decided ? tally.in_margin : least <= level ? tally.misses : tally.false_alarms;
    ++count;
    if (!decided) continue;
    ADD_FAILURE() << (least <= level ? "missed" : "false alarm") << " at level " << level << ", seed " << seed
                  << ", case " << k << '\n'
                  << test::paste(beads) << test::paste(shape) << test::paste(X);
  }
}

void expect_no_miss(const Tally& tally) {
  EXPECT_EQ(tally.misses, 0);
  EXPECT_EQ(tally.false_alarms, 0);
  // Either kind is common, and next to nothing is left undecided.
  EXPECT_GT(tally.contacts, tally.cases / 5);
  EXPECT_LT(tally.contacts, tally.cases * 4 / 5);
  EXPECT_LT(tally.in_margin, 1 + tally.cases / 500);
}

TEST(BeadOracle, MissesNothingThatFclFindsAndNamesNothingThatItDoesNot) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) run_scene(seed, 100, tally);
  EXPECT_EQ(tally.cases, 20000);
  expect_no_miss(tally);
}

TEST(SlowBeadOracle, NoMissInAMillionRandomCases) {
  Tally tally;
  for (std::uint64_t seed = 100001; seed <= 110000; ++seed) run_scene(seed, 100, tally);
  EXPECT_EQ(tally.cases, 1000000);
  RecordProperty("contacts", tally.contacts);
  RecordProperty("undecided by FCL", tally.in_margin);
  std::printf("%d cases, %d contacts, %d missed, %d false, %d undecided\n", tally.cases, tally.contacts,
              tally.misses, tally.false_alarms, tally.in_margin);
  expect_no_miss(tally);
}

// Thousands of beads: the same answers as from looking at every one, ties included.
TEST(BeadOracle, TheTreeAnswersAsLookingAtEveryBeadDoes) {
  constexpr double kTie = 2e-9;  // [m], stated
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed, "bead tree");
    const std::vector<Bead> beads =
        seed % 2 == 0 ? test::random_beads(random, 1500, 12e-3) : test::zigzag(1500, 6e-3, 0.2e-3, 1e-3);
    BeadIndex index;
    for (const Bead& bead : beads) index.add(bead);
    for (int k = 0; k < 60; ++k) {
      const geometry::Shape shape = test::random_shape(random);
      const ConvexSolid solid = *convex_solid(shape);
      const Vec3 place = test::random_vector(random, 12e-3);
      const Pose X = make_pose(exp_rotation(test::random_vector(random, 2)), place);
      const std::size_t before = random.bits() % 2 == 0 ? beads.size() : random.bits() % beads.size();
      std::vector<double> all, points, rays;
      const Vec3 direction = X.linear().col(2);
      for (std::size_t i = 0; i < before; ++i) {
        const BeadCore core = core_of(beads[i]);
        all.push_back(std::visit(
            [&](const auto& c) { return separation(c, solid.radius, X, core, kInfinity).distance; },
            solid.core));
        points.push_back(signed_distance(core, place));
        rays.push_back(entry(core, place, direction, kInfinity).value_or(kInfinity));
      }
      const auto compare = [&](const std::vector<double>& distances, bool found, double distance,
                               std::size_t bead, const char* what) {
        const double least =
            distances.empty() ? kInfinity : *std::min_element(distances.begin(), distances.end());
        const auto first =
            std::find_if(distances.begin(), distances.end(), [&](double d) { return d <= least + kTie; });
        ASSERT_EQ(found, std::isfinite(least)) << what << ", seed " << seed << ", case " << k;
        if (!found) return;
        EXPECT_EQ(bead, static_cast<std::size_t>(first - distances.begin()))
            << what << ", seed " << seed << ", case " << k << '\n'
            << test::paste(shape) << test::paste(X);
        EXPECT_NEAR(distance, least, kTie) << what << ", seed " << seed << ", case " << k;
      };
      const auto near = index.nearest(solid, X, kInfinity, before);
      compare(all, near.has_value(), near ? near->separation.distance : 0, near ? near->bead : 0, "nearest");
      const auto surface = index.nearest_surface(place, kInfinity, before);
      compare(points, surface.has_value(), surface ? surface->distance : 0, surface ? surface->bead : 0,
              "surface");
      const auto hit = index.ray_hit(place, direction, kInfinity, before);
      compare(rays, hit.has_value(), hit ? hit->distance : 0, hit ? hit->bead : 0, "ray");
    }
  }
}

TEST(BeadIndexSize, IsAtMostSixtyFourBytesABead) {
  struct {
    double side, shortest, longest;
  } const prints[] = {
      {40e-3, 0.2e-3, 1e-3}, {40e-3, 0.5e-3, 1e-3}, {300e-3, 0.2e-3, 1e-3}};  // the last: flat
  for (const auto& print : prints) {
    BeadIndex index;
    for (const Bead& bead : test::zigzag(200000, print.side, print.shortest, print.longest)) index.add(bead);
    EXPECT_LE(static_cast<double>(index.bytes()) / static_cast<double>(index.size()), 64) << print.side;
  }
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A hundred times the beads: linear would take a hundred times as long, three more levels of a tree perhaps
// twice; the rest is for a busy computer.
TEST(BeadIndexSize, AHundredTimesTheBeadsTakeNoTenTimesTheTime) {
  const ConvexSolid nozzle{FrustumCore{0.5e-3, 3.5e-3, 0, 12e-3}, 0};
  const auto best_time = [&](std::size_t count, double side) {
    BeadIndex index;
    for (const Bead& bead : test::zigzag(count, side, 0.5e-3, 1e-3)) index.add(bead);
    double best = kInfinity;
    for (int turn = 0; turn < 5; ++turn) {
      Random random(1, "queries");
      const double begin = cpu_seconds();
      for (int k = 0; k < 300; ++k) {
        const Vec3 p(random.uniform(0, side), random.uniform(0, side),
                     side / 3 + random.uniform(0.3e-3, 1e-3));
        index.nearest(nozzle, make_pose(exp_rotation(Vec3(0.2, 0.1, 0)), p), 2e-3);
      }
      best = std::min(best, cpu_seconds() - begin);
    }
    return best;
  };
  EXPECT_LT(best_time(100000, 26.5e-3), 10 * best_time(1000, 5.7e-3));
}

}  // namespace
}  // namespace understudy::sim
