#include "sim/beads/bead_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/sim/beads/beads_for_tests.h"

namespace understudy::sim {
namespace {

using test::flat_bead;
using test::round_bead;

// Coordinates to 20 mm are rounded to floats: 1 nm each, some of them added; twice the distance's own 2 nm.
constexpr double kFloat = 6e-9;
constexpr double kFar = 1.0;  // [m], no cut-off that matters

ConvexSolid sphere(double radius) { return {PointCore{}, radius}; }
ConvexSolid capsule(double radius, double length) { return {SegmentCore{length / 2}, radius}; }
ConvexSolid nozzle() { return {FrustumCore{0.5e-3, 3.5e-3, 0, 12e-3}, 0}; }
Pose at(const Vec3& p, const Vec3& turn = Vec3::Zero()) { return make_pose(exp_rotation(turn), p); }

double distance(const BeadIndex& index, const ConvexSolid& solid, const Pose& X) {
  return index.nearest(solid, X, kFar).value().separation.distance;
}

TEST(BeadIndex, SphereIsAsFarFromAFlatBeadAsFromItsRoundedRectangle) {
  BeadIndex index;
  index.add(
      flat_bead(Vec3(-2e-3, 0, 1e-3), Vec3(2e-3, 0, 1e-3)));  // 0.4 x 0.2 mm: flat to 0.1 mm at either side
  for (const double x : {0.0, 1.9e-3, 2.5e-3}) {
    for (const double y : {0.0, 0.08e-3, -0.6e-3}) {
      for (const double z : {1.3e-3, 1.0e-3, 0.2e-3}) {
        const double core =
            Vec3(std::max(0.0, x - 2e-3), std::max(0.0, std::abs(y) - 0.1e-3), z - 1e-3).norm();
        EXPECT_NEAR(distance(index, sphere(0.05e-3), at(Vec3(x, y, z))), core - 0.15e-3, kFloat)
            << x << y << z;
      }
    }
  }
}

TEST(BeadIndex, RoundBeadIsACapsule) {
  BeadIndex index;
  index.add(round_bead(Vec3(-2e-3, 0, 0), Vec3(2e-3, 0, 0), 0.4e-3));
  // Crossed at 60 degrees 1 mm above, and side by side.
  EXPECT_NEAR(
      distance(index, capsule(0.1e-3, 6e-3), at(Vec3(0.3e-3, 0, 1e-3), Vec3(-std::numbers::pi / 2, 0, 0))),
      0.7e-3, kFloat);
  EXPECT_NEAR(
      distance(index, capsule(0.1e-3, 2e-3), at(Vec3(0, 0.8e-3, 0), Vec3(0, std::numbers::pi / 2, 0))),
      0.5e-3, kFloat);
}

TEST(BeadIndex, NozzleOverABeadIsItsLowestRimAway) {
  BeadIndex index;
  index.add(flat_bead(Vec3(0, -9e-3, 0.1e-3), Vec3(0, 9e-3, 0.1e-3)));
  for (double tilt_deg = 0; tilt_deg <= 40; tilt_deg += 5) {
    const double tilt = from_deg(tilt_deg);
    const auto near = index.nearest(nozzle(), at(Vec3(0, 0, 0.8e-3), Vec3(tilt, 0, 0)), 2e-3);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->separation.distance, 0.6e-3 - 0.5e-3 * std::sin(tilt), kFloat) << tilt_deg;
    EXPECT_NEAR(near->separation.place_W.z(), 0.2e-3, kFloat);
  }
}

TEST(BeadIndex, BoxOverABeadIsItsFaceAway) {
  BeadIndex index;
  index.add(flat_bead(Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0)));
  const ConvexSolid box{BoxCore{Vec3(8e-3, 8e-3, 5e-3)}, 0};
  EXPECT_NEAR(distance(index, box, at(Vec3(3e-3, -2e-3, 5.4e-3))), 0.3e-3, kFloat);
}

TEST(BeadIndex, BlobIsADiscWithARoundRim) {
  BeadIndex index;
  index.add(flat_bead(Vec3(1e-3, 0, 0), Vec3(1e-3, 0, 0), 1.2e-3, 0.2e-3));
  for (const double angle : {0.0, 0.7, 2.0}) {
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(distance(index, sphere(0.1e-3), at(Vec3(1e-3, 0, 0) + 2e-3 * out)), 1.3e-3, kFloat);
    EXPECT_NEAR(distance(index, sphere(0.1e-3), at(Vec3(1e-3, 0, 1e-3) + 0.4e-3 * out)), 0.8e-3, kFloat);
    EXPECT_NEAR(distance(index, nozzle(), at(Vec3(1e-3, 0, 0.5e-3) + 0.4e-3 * out)), 0.4e-3, kFloat);
  }
}

TEST(BeadIndex, ItsFlatSideFacesTheToolThatLaidIt) {
  BeadIndex index;
  Bead bead = flat_bead(Vec3(-2e-3, 0, 0), Vec3(2e-3, 0, 0));
  bead.up_W = {0, 1, 0};  // laid from the side
  index.add(bead);
  EXPECT_NEAR(distance(index, sphere(0), at(Vec3(0, 0, 1e-3))), 0.8e-3, kFloat);
  EXPECT_NEAR(distance(index, sphere(0), at(Vec3(0, 1e-3, 0))), 0.9e-3, kFloat);
}

TEST(BeadIndex, HeightIsTheToolAxisAcrossAClimbingPath) {
  BeadIndex index;
  const double slope = from_deg(30);
  const Vec3 along(std::cos(slope), 0, std::sin(slope)), up(-std::sin(slope), 0, std::cos(slope));
  index.add(flat_bead(-2e-3 * along, 2e-3 * along));  // laid by a tool that stayed vertical
  EXPECT_NEAR(distance(index, sphere(0), at(1e-3 * up)), 0.9e-3, kFloat);
  EXPECT_NEAR(distance(index, sphere(0), at(Vec3(0, 1e-3, 0))), 0.8e-3, kFloat);
}

TEST(BeadIndex, OverlapIsAsDeepAsTheNozzleIsPressedIn) {
  BeadIndex index;
  index.add(flat_bead(Vec3(-2e-3, 0, 0.1e-3), Vec3(2e-3, 0, 0.1e-3)));
  for (const double pressed : {1e-6, 0.05e-3, 0.1e-3, 0.15e-3}) {
    const auto near = index.nearest(nozzle(), at(Vec3(0, 0, 0.2e-3 - pressed)), 2e-3);
    ASSERT_TRUE(near);
    // The deepest point of overlapping cores is found to 0.5 um each way.
    EXPECT_NEAR(near->separation.distance, -pressed, pressed > 0.1e-3 ? 1e-6 : kFloat) << pressed;
  }
  // A sphere about a point of the path: both radii.
  EXPECT_NEAR(distance(index, sphere(0.3e-3), at(Vec3(1e-3, 0, 0.1e-3))), -0.4e-3, kFloat);
}

TEST(BeadIndex, DeepestOfManyOverlapsCounts) {
  BeadIndex index;
  for (int i = 0; i < 20; ++i)
    index.add(flat_bead(Vec3(-2e-3, 0, 0.1e-3 + 0.2e-3 * i), Vec3(2e-3, 0, 0.1e-3 + 0.2e-3 * i)));
  // 3 mm below the top of a wall as thin as a line: the deepest in the nozzle is where a flank is as far as
  // the flat; along the axis depth min(z, R(z) cos a) grows, so the top bead's rim at 3 mm is deepest.
  const double half_angle = std::atan2(3e-3, 12e-3);
  const double expected = (0.5e-3 + 0.25 * 2.9e-3) * std::cos(half_angle) + 0.1e-3;
  const auto near = index.nearest(nozzle(), at(Vec3(0, 0, 1e-3)), 2e-3);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->separation.distance, -expected, 1e-6);
  EXPECT_EQ(near->bead, 19U);
}

// Found by a property. The frustum's surface runs through the box of the first three, whose nearest point is
// then one of the frustum up to rounding: what that rounding points to must not rule out a deeper bead.
TEST(BeadIndex, ABoxThatTheSurfaceRunsThroughHidesNoDeeperBead) {
  const std::vector<Bead> beads = {{{-3.27463204e-05F, -0.00022051220F, 0.00014126234F},
                                    {0.000611219322F, -0.000591284188F, 0.000528760662F},
                                    {0, 0, 1},
                                    0.000829336292F,
                                    0.000259100168F},
                                   {{0.000611219322F, -0.000591284188F, 0.000528760662F},
                                    {0.000611219322F, -0.000591284188F, 0.000528760662F},
                                    {0, 0, 1},
                                    0.0014865438F,
                                    0.000478351896F},
                                   {{0.000611219322F, -0.000591284188F, 0.000528760662F},
                                    {0.000377761695F, -0.00131719094F, 0.000151422108F},
                                    {0, 0, 1},
                                    0.00115447468F,
                                    0.000477768976F},
                                   {{0.000377761695F, -0.00131719094F, 0.000151422108F},
                                    {5.67074749e-05F, -0.00131719094F, 0.000151422108F},
                                    {0, -0.513199568F, 0.858269334F},
                                    0.000357028708F,
                                    0.000202861207F}};
  BeadIndex index;
  for (const Bead& bead : beads) index.add(bead);
  Pose X = Pose::Identity();
  X.matrix() << 0.44632213739773952, 0.54713325062157392, -0.70812552258267292, 0.000392804296920076,
      -0.55769256685063906, -0.44878701527883846, -0.69826156689070129, -0.00077844587422441693,
      -0.69983966059966851, 0.7065659353389333, 0.10482856705287658, -0.00041481228149496023, 0, 0, 0, 1;
  const ConvexSolid frustum{
      FrustumCore{0.00046415825404692444, 0.00092831650809384889, 0, 0.0015696288889274002}, 0};
  BeadIndex third;  // alone it is found
  third.add(beads[2]);
  for (int k = 0; k < 100; ++k) {  // rounding differs from place to place
    const auto near = index.nearest(frustum, X, kFar);
    ASSERT_EQ(near->bead, 2U) << k;
    EXPECT_EQ(near->separation.distance, distance(third, frustum, X)) << k;
    X.translation().x() += 1e-9;
  }
}

TEST(BeadIndex, TurningEverythingChangesNothing) {
  Random random(3, "turned beads");
  const std::vector<Bead> beads = test::random_beads(random, 60, 5e-3);
  BeadIndex straight;
  for (const Bead& bead : beads) straight.add(bead);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose X = at(test::random_vector(random, 20e-3), test::random_vector(random, 2));
    BeadIndex turned;
    for (const Bead& bead : beads) turned.add(test::moved(bead, X));
    for (int k = 0; k < 20; ++k) {
      const Pose X_S = at(test::random_vector(random, 6e-3), test::random_vector(random, 2));
      const ConvexSolid solid = test::random_solid(random);
      const double d = distance(straight, solid, X_S);
      // Depths of overlapping cores are within 1 um, and a bead's up within 1e-7.
      EXPECT_NEAR(distance(turned, solid, X * X_S), d, d > -50e-6 ? 5 * kFloat : 2e-6);
    }
  }
}

TEST(BeadIndex, OrderOfAddingChangesNothing) {
  Random random(4, "order of beads");
  std::vector<Bead> beads = test::random_beads(random, 300, 8e-3);
  BeadIndex forwards, backwards;
  for (const Bead& bead : beads) forwards.add(bead);
  std::reverse(beads.begin(), beads.end());
  for (const Bead& bead : beads) backwards.add(bead);
  for (int k = 0; k < 300; ++k) {
    const Pose X = at(test::random_vector(random, 9e-3), test::random_vector(random, 2));
    const ConvexSolid solid = test::random_solid(random);
    // Where two beads tie within 2 nm, either order names its own first.
    EXPECT_NEAR(distance(forwards, solid, X), distance(backwards, solid, X), 2e-9);
  }
}

TEST(BeadIndex, OfBeadsThatTieTheFirstIsNamed) {
  for (const bool reverse : {false, true}) {
    BeadIndex index;
    const auto bead = [](double x) { return flat_bead(Vec3(x, 0, 0), Vec3(x + 1e-3, 0, 0)); };
    for (const int i : reverse ? std::vector{2, 1, 0} : std::vector{0, 1, 2}) index.add(bead(1e-3 * i));
    // Over the joint of the middle one, and of all three.
    EXPECT_EQ(index.nearest(sphere(0.1e-3), at(Vec3(1e-3, 0, 1e-3)), kFar)->bead, reverse ? 1U : 0U);
    EXPECT_EQ(
        index.nearest(ConvexSolid{BoxCore{Vec3(5e-3, 1e-3, 1e-3)}, 0}, at(Vec3(0, 0, 2e-3)), kFar)->bead, 0U);
    EXPECT_EQ(index.ray_hit(Vec3(1e-3, 0, 1e-3), -Vec3::UnitZ(), kFar)->bead, reverse ? 1U : 0U);
  }
}

TEST(BeadIndex, BeadsFromBeforeOnAreNotThere) {
  BeadIndex index;
  for (int i = 0; i < 10; ++i) index.add(flat_bead(Vec3(-1e-3, 0, 0.2e-3 * i), Vec3(1e-3, 0, 0.2e-3 * i)));
  for (std::size_t before = 1; before <= 10; ++before) {
    const double top = 0.2e-3 * static_cast<double>(before - 1) + 0.1e-3;
    const Vec3 p(0, 0, 5e-3);
    EXPECT_NEAR(index.nearest(nozzle(), at(p), kFar, before)->separation.distance, 5e-3 - top, kFloat);
    EXPECT_NEAR(index.ray_hit(p, -Vec3::UnitZ(), kFar, before)->distance, 5e-3 - top, kFloat);
    EXPECT_NEAR(index.nearest_surface(p, kFar, before)->distance, 5e-3 - top, kFloat);
    EXPECT_NEAR(index.way_out(Vec3::Zero(), Vec3::UnitZ(), 1e-6, before)->distance, top, kFloat);
  }
  EXPECT_FALSE(index.nearest(nozzle(), at(Vec3(0, 0, 5e-3)), kFar, 0));
}

TEST(BeadIndex, NothingWithinTheCutoffIsNothing) {
  BeadIndex index;
  EXPECT_FALSE(index.nearest(nozzle(), Pose::Identity(), kFar));
  EXPECT_FALSE(index.ray_hit(Vec3(0, 0, 1), -Vec3::UnitZ(), 2));
  EXPECT_FALSE(index.nearest_surface(Vec3::Zero(), kFar));
  index.add(flat_bead(Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0)));
  EXPECT_FALSE(index.nearest(sphere(0), at(Vec3(0, 0, 2.101e-3)), 2e-3));
  EXPECT_TRUE(index.nearest(sphere(0), at(Vec3(0, 0, 2.099e-3)), 2e-3));
  EXPECT_FALSE(index.ray_hit(Vec3(0, 0, 2.101e-3), -Vec3::UnitZ(), 2e-3));
  EXPECT_FALSE(index.ray_hit(Vec3(0, 0, 2e-3), Vec3::UnitZ(), 1)) << "it looks away";
}

TEST(BeadIndex, LongAndFarBeadsAreFoundEverywhere) {
  BeadIndex index;
  index.add(flat_bead(Vec3(-50e-3, -50e-3, 0), Vec3(50e-3, 50e-3, 20e-3), 0.4e-3, 0.4e-3));
  index.add(flat_bead(Vec3(-90, 3, 0), Vec3(-90, 3, 0), 8e-3, 8e-3));  // as big as its neighbours' cells
  index.add(round_bead(Vec3(80, 80, 80), Vec3(80, 80.05, 80), 0.25));
  const Vec3 along = Vec3(100e-3, 100e-3, 20e-3).normalized(),
             aside = along.cross(Vec3::UnitZ()).normalized();
  for (double s = -70e-3; s <= 70e-3; s += 1.7e-3) {
    const auto near = index.nearest(sphere(0.1e-3), at(Vec3(0, 0, 10e-3) + s * along + 1e-3 * aside), 2e-3);
    ASSERT_TRUE(near) << s;
    EXPECT_NEAR(near->separation.distance, 0.7e-3, kFloat) << s;
    EXPECT_EQ(near->bead, 0U);
  }
  // Floats of 90 m are 4 um apart.
  EXPECT_NEAR(distance(index, sphere(1e-3), at(Vec3(-90, 3, 0.1))), 0.095, 8e-6);
  EXPECT_NEAR(distance(index, sphere(1e-3), at(Vec3(80, 80, 81))), 0.874, 8e-6);
}

TEST(BeadIndex, RefusesWhatIsNoBead) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [](auto change) {
    BeadIndex index;
    Bead bead = flat_bead(Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0));
    bead.line = 1187;
    index.add(bead);
    change(bead);
    try {
      index.add(bead);
    } catch (const InputError& e) {
      EXPECT_EQ(index.size(), 1U);
      return std::string(e.what()).find("1187") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused([&](Bead& b) { b.from_W[1] = nan; }));
  EXPECT_TRUE(refused([](Bead& b) { b.to_W[2] = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(refused([](Bead& b) { b.to_W[2] = 101; }));
  EXPECT_TRUE(refused([](Bead& b) { b.height = 0; }));
  EXPECT_TRUE(refused([](Bead& b) { b.height = -0.1e-3F; }));
  EXPECT_TRUE(refused([&](Bead& b) { b.height = nan; }));
  EXPECT_TRUE(refused([](Bead& b) { b.width = 0.19e-3F; }));
  EXPECT_TRUE(refused([&](Bead& b) { b.width = nan; }));
  EXPECT_TRUE(refused([](Bead& b) { b.up_W = {0, 0, 0}; }));
  EXPECT_TRUE(refused([](Bead& b) { b.up_W = {0, 0, 2}; }));
  EXPECT_TRUE(refused([&](Bead& b) { b.laid_at = nan; }));
}

TEST(BeadIndex, RefusesToAnswerForNowhere) {
  BeadIndex index;
  index.add(flat_bead(Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(index.nearest(nozzle(), at(Vec3(nan, 0, 0)), 1), MachineError);
  EXPECT_THROW(index.nearest(nozzle(), at(Vec3::Zero()), nan), MachineError);
  EXPECT_THROW(index.ray_hit(Vec3(0, 0, 1), Vec3(0, nan, -1), 1), MachineError);
  EXPECT_THROW(index.nearest_surface(Vec3(0, nan, 0), 1), MachineError);
}

}  // namespace
}  // namespace understudy::sim
