#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "sim/collision/collision.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

Snapshot at(double time, const Vec3& tip, int line) {
  Snapshot s;
  s.time = time;
  s.X_WT = make_pose(Quat::Identity(), tip);
  s.line = line;
  return s;
}

Bead bead(const Vec3& from, const Vec3& to, int line, double width = 0.5e-3, double height = 0.2e-3) {
  Bead b;
  for (std::size_t i = 0; i < 3; ++i) {
    b.from_W[i] = static_cast<float>(from[static_cast<int>(i)]);
    b.to_W[i] = static_cast<float>(to[static_cast<int>(i)]);
  }
  b.width = static_cast<float>(width);
  b.height = static_cast<float>(height);
  b.line = line;
  return b;
}

struct Stage {
  explicit Stage(std::function<std::size_t()> fresh = {}) {
    CollisionOptions options;
    options.beads = &beads;
    options.fresh_from = std::move(fresh);
    const auto machine = test::hexapod();
    observer = std::make_unique<CollisionObserver>(machine, test::as_designed(machine), nullptr, options);
  }
  BeadIndex beads;
  std::unique_ptr<CollisionObserver> observer;
};

// A strut printed upright, 4 mm tall, stands in the nozzle's way.
TEST(GrowingObstacle, TheNozzleHitsWhatWasPrintedBefore) {
  Stage stage;
  stage.observer->observe(at(0, {0, 0, 0.05}, 1));
  stage.beads.add(bead({10e-3, 0, 0.048}, {10e-3, 0, 0.052}, 3, 0.48e-3, 0.48e-3));
  stage.observer->observe(at(1, {20e-3, 0, 0.05}, 7));
  const auto hits = stage.observer->collisions();
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits[0].body, "nozzle");
  EXPECT_EQ(hits[0].obstacle, "bead of line 3");
  EXPECT_EQ(hits[0].line, 7);
  EXPECT_NEAR(hits[0].place_W.x(), 10e-3, 0.3e-3);
  EXPECT_LT(hits[0].clearance, -0.1e-3);
}

TEST(GrowingObstacle, LevelWithItsOwnLayerIsNoCollisionAndAPressOfATenthIsNone) {
  for (const double deep : {0.0, 0.09e-3, 0.15e-3}) {
    Stage stage;
    stage.observer->observe(at(0, {-10e-3, 0, 0.05}, 1));
    stage.beads.add(bead({0, -5e-3, 0.05 - 0.1e-3}, {0, 5e-3, 0.05 - 0.1e-3}, 2));  // its top is at 50 mm
    stage.observer->observe(at(1, {-10e-3, 0, 0.05 - deep}, 5));
    stage.observer->observe(at(2, {10e-3, 0, 0.05 - deep}, 6));
    EXPECT_EQ(stage.observer->collisions().size(), deep > 0.1e-3 ? 1u : 0u) << deep;
  }
}

// The bead's top is at 50 mm: 0.15 mm deep is 0.15 mm deep, and 0.09 mm is the nozzle at its work, whose
// nearest is then the table.
TEST(GrowingObstacle, TheNozzlesLeastClearanceCountsBeadsThatItPloughs) {
  for (const double deep : {0.09e-3, 0.15e-3}) {
    Stage stage;
    stage.observer->observe(at(0, {-10e-3, 0, 0.05}, 1));
    stage.beads.add(bead({0, -5e-3, 0.05 - 0.1e-3}, {0, 5e-3, 0.05 - 0.1e-3}, 2));
    stage.observer->observe(at(1, {-10e-3, 0, 0.05 - deep}, 5));
    stage.observer->observe(at(2, {10e-3, 0, 0.05 - deep}, 6));
    const bool ploughs = deep > 0.1e-3;
    EXPECT_NEAR(stage.observer->min_nozzle_clearance(), ploughs ? -deep : 0.05 - deep,
                ploughs ? 0.02e-3 : 0.01e-3);
    EXPECT_GT(stage.observer->min_clearance(), 1e-3) << "of everything else";
  }
}

TEST(GrowingObstacle, TheFreshestMaterialIsContactByDesign) {
  std::size_t fresh = 0;
  Stage stage([&] { return fresh; });
  stage.observer->observe(at(0, {0, 0, 0.05}, 1));
  stage.beads.add(bead({0, 0, 0.0505}, {1e-3, 0, 0.0505}, 2));
  stage.observer->observe(at(1, {0.5e-3, 0, 0.05}, 3));
  EXPECT_TRUE(stage.observer->collisions().empty());
  fresh = 1;  // it has cooled
  stage.observer->observe(at(2, {0.6e-3, 0, 0.05}, 4));
  ASSERT_EQ(stage.observer->collisions().size(), 1u);
  EXPECT_EQ(stage.observer->collisions()[0].line, 4);
}

// The heater block starts 12 mm above the tip; fresh or not, it may touch nothing.
TEST(GrowingObstacle, OtherBodiesMindFreshBeadsToo) {
  Stage stage([] { return std::size_t{0}; });
  stage.observer->observe(at(0, {0, 0, 0.05}, 1));
  stage.beads.add(bead({7e-3, 0, 0.05}, {7e-3, 0, 0.0635}, 2));
  stage.observer->observe(at(1, {0.01e-3, 0, 0.05}, 3));
  const auto hits = stage.observer->collisions();
  EXPECT_TRUE(
      std::any_of(hits.begin(), hits.end(), [](const Contact& c) { return c.body == "heater block"; }));
}

TEST(GrowingObstacle, ABeadLaidBesideARestingBodyIsMindedAtTheNextMotion) {
  Stage stage;
  // Far flights give every pair a large budget of motion; the new bead must take it away.
  stage.observer->observe(at(0, {-30e-3, 0, 0.06}, 1));
  stage.observer->observe(at(1, {0, 0, 0.06}, 2));
  stage.beads.add(bead({2e-3, -5e-3, 0.061}, {2e-3, 5e-3, 0.061}, 3));
  stage.observer->observe(at(2, {1.5e-3, 0, 0.06}, 4));
  EXPECT_EQ(stage.observer->collisions().size(), 1u);
}

// Lines across x, 0.5 mm apart and level with the tip at 50 mm, but for one that stands out.
struct Layer : Stage {
  explicit Layer(double out) {
    observer->observe(at(0, {-10e-3, 0, 0.06}, 1));
    for (int k = -20; k <= 20; ++k) {
      const double z = 0.05 - 0.1e-3 + (k == 10 ? out : 0);
      beads.add(bead({0.5e-3 * k, -5e-3, z}, {0.5e-3 * k, 5e-3, z}, 2));
    }
    for (int k = 0; k <= 200; ++k) observer->observe(at(1 + 0.01 * k, {-10e-3 + 0.1e-3 * k, 0, 0.05}, 5));
  }
};

// Deeper than a tenth of a millimetre is a contact, and its depth is known as well.
TEST(GrowingObstacle, ABeadThatStandsOutOfTheLayerUnderTheNozzleIsFound) {
  for (const double out : {0.0, 0.09e-3, 0.12e-3, 0.25e-3, 0.6e-3}) {
    Layer layer(out);
    const auto hits = layer.observer->collisions();
    ASSERT_EQ(hits.size(), out > 0.1e-3 ? 1u : 0u) << out;
    if (hits.empty()) continue;
    EXPECT_EQ(hits[0].body, "nozzle");
    EXPECT_GE(hits[0].clearance, -out - 1e-6);
    EXPECT_LE(hits[0].clearance, -std::max(0.1e-3, out - 0.1e-3));
  }
}

TEST(GrowingObstacle, AboveTheLayerTheNozzleIsLookedAtSeldom) {
  Layer layer(0);
  Stage bare;
  const auto fly = [](CollisionObserver& observer) {
    observer.observe(at(4, {10e-3, 0, 0.055}, 6));
    const auto before = observer.checks();
    for (int k = 0; k <= 200; ++k) observer.observe(at(5 + 0.01 * k, {10e-3 - 0.1e-3 * k, 0, 0.055}, 6));
    return observer.checks() - before;
  };
  bare.observer->observe(at(0, {-10e-3, 0, 0.06}, 1));
  // 20 mm of motion 5 mm above the beads: a look every few millimetres, of the nozzle and of the heater
  // block.
  EXPECT_LE(fly(*layer.observer), fly(*bare.observer) + 20);
}

// Nothing comes nearer to another body than the cooling duct to the table, which is too far to mind.
TEST(GrowingObstacle, BeadsFarFromTheHeadCostFewChecks) {
  const auto machine = machine::load_machine("five-axis");
  BeadIndex beads;
  beads.add(bead({-30e-3, 0, 0.1e-3}, {30e-3, 0, 0.1e-3}, 1));
  const auto fly = [&](const BeadIndex* printed) {
    CollisionOptions options;
    options.beads = printed;
    CollisionObserver observer(machine, make_as_built(machine, "nominal", 1), nullptr, options);
    for (int k = 0; k <= 1000; ++k) observer.observe(at(0.01 * k, {-20e-3 + 40e-6 * k, 0, 2e-3}, 2));
    EXPECT_GT(observer.min_clearance(), 5e-3);
    return observer.checks();
  };
  // 40 mm of motion: every other millimetre or so for each of the nozzle, the heater block, the duct and the
  // carriage.
  EXPECT_LE(fly(&beads), fly(nullptr) + 100);
}

}  // namespace
}  // namespace understudy::sim
