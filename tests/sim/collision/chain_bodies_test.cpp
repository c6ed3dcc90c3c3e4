// Links of open chains: where they are in the frame of the work, and how far they can move.
#include "sim/collision/chain_bodies.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "sim/collision/collision.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

std::size_t item_named(const ChainBodies& bodies, const std::string& name) {
  for (std::size_t i = 0; i < bodies.items().size(); ++i)
    if (bodies.items()[i].shape.name == name) return i;
  ADD_FAILURE() << "no " << name;
  return 0;
}

TEST(ChainBodies, AnArmsLinksTurnWithTheAxesThatCarryThem) {
  const auto machine = machine::load_machine("arm");
  ChainBodies bodies(machine, make_as_built(machine, "nominal", 1));
  const std::size_t upper = item_named(bodies, "upper arm");
  const Vec3 zero(0.150, 0, 0.430);  // the middle between (150, 0, 300) and (150, 0, 560) mm
  bodies.pose({});
  EXPECT_LT((bodies.place(upper).translation() - machine.X_WB * zero).norm(), 1e-15);
  AxisVector axes{};
  axes[0] = from_deg(90);  // about the base's z
  bodies.pose(axes);
  EXPECT_LT((bodies.place(upper).translation() - machine.X_WB * Vec3(0, 0.150, 0.430)).norm(), 1e-15);
  axes[0] = 0;
  axes[1] = from_deg(90);  // the upper arm leans forward about (150, *, 300) mm
  bodies.pose(axes);
  EXPECT_LT((bodies.place(upper).translation() - machine.X_WB * Vec3(0.280, 0, 0.300)).norm(), 1e-15);
  axes = {};
  axes[2] = from_deg(30);  // beyond it
  bodies.pose(axes);
  EXPECT_LT((bodies.place(upper).translation() - machine.X_WB * zero).norm(), 1e-15);
}

TEST(ChainBodies, ADrivesZeroIsWhereItWasBuilt) {
  const auto machine = machine::load_machine("arm");
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.axis_zero[0] = from_deg(90);
  ChainBodies bodies(machine, built);
  bodies.pose({});
  EXPECT_LT(
      (bodies.place(item_named(bodies, "upper arm")).translation() - machine.X_WB * Vec3(0, 0.150, 0.430))
          .norm(),
      1e-15);
}

// The cradle hangs on B below the table, which is the world: seen from there it turns about the table's own
// axis only, and what B does moves everything but the cradle.
TEST(ChainBodies, WhatCarriesTheTableStandsStillBelowIt) {
  const auto machine = machine::load_machine("five-axis");
  ChainBodies bodies(machine, make_as_built(machine, "nominal", 1));
  const std::size_t cradle = item_named(bodies, "cradle");
  bodies.pose({});
  const Pose X_zero = bodies.place(cradle);
  AxisVector axes{0.05, -0.03, 0.02, from_deg(40), 0};
  bodies.pose(axes);
  EXPECT_LT((bodies.place(cradle).matrix() - X_zero.matrix()).norm(), 1e-15);
  axes[4] = from_deg(30);
  bodies.pose(axes);
  const Mat3 turn = bodies.place(cradle).linear() * X_zero.linear().transpose();
  EXPECT_NEAR(angle_between(turn, Mat3::Identity()), from_deg(30), 1e-12);
  EXPECT_NEAR(turn(2, 2), 1, 1e-15);
}

/// Corners of a box that holds the shape, in its own frame.
std::vector<Vec3> points_of(const geometry::Shape& shape) {
  Vec3 half(0, 0, 0);
  if (const auto* capsule = std::get_if<geometry::Capsule>(&shape.form)) half.z() = capsule->length / 2;
  if (const auto* box = std::get_if<geometry::Box>(&shape.form)) half = box->size / 2;
  std::vector<Vec3> points;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) points.push_back(half.cwiseProduct(Vec3(x, y, z)));
  return points;
}

class LinkMotion : public testing::TestWithParam<const char*> {};

// What the sweep of collisions relies on: no point of a link moves farther than is said.
TEST_P(LinkMotion, IsNeverMoreThanItsBound) {
  const auto machine = machine::load_machine(GetParam());
  ChainBodies bodies(machine, make_as_built(machine, "sampled", 2));
  const auto& axes = machine.chain().kinematics.chain.axes;
  Random random(81, "link motion");
  int moved = 0;
  double tightest = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    AxisVector from{}, to{}, travel{};
    const std::size_t only = trial % 2 == 0 ? static_cast<std::size_t>(trial / 2) % axes.size() : axes.size();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double low = std::max(axes[i].lower, -3.0), high = std::min(axes[i].upper, 3.0);
      from[i] = random.uniform(low, high);
      if (only == axes.size() || only == i) travel[i] = random.uniform(0, axes[i].angle ? 0.02 : 0.002);
      to[i] = from[i] + (random.uniform(0, 1) < 0.5 ? -travel[i] : travel[i]);
    }
    for (std::size_t item = 0; item < bodies.items().size(); ++item) {
      bodies.pose(from);
      const Pose X_from = bodies.place(item);
      bodies.pose(to);
      const Pose X_to = bodies.place(item);
      const double bound = bodies.motion(item, travel);
      for (const Vec3& p : points_of(bodies.items()[item].shape)) {
        const double motion = (X_to * p - X_from * p).norm();
        ASSERT_LE(motion, bound + 1e-15) << bodies.items()[item].shape.name << ", trial " << trial;
        if (bound > 0) tightest = std::max(tightest, motion / bound);
        moved += motion > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(moved, 1000);
  EXPECT_GT(tightest, 0.2);  // and it is a bound to work with
}

INSTANTIATE_TEST_SUITE_P(Machines, LinkMotion, testing::Values("arm", "five-axis"), [](const auto& one) {
  std::string name = one.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

TEST(ChainCollision, AnElbowThatMeetsTheTableIsSeenWhereTheArmReallyIs) {
  const auto machine = machine::load_machine("arm");
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  CollisionObserver observer(machine, built, nullptr, {});
  Snapshot s;
  s.X_WT = machine.X_WB * machine.X_BT_home;
  for (std::size_t i = 0; i < 6; ++i) s.axes[i] = s.axes_reached[i] = machine.chain().kinematics.home[i];
  observer.observe(s);
  EXPECT_TRUE(observer.collisions().empty());
  // The port goes on telling home; the second axis has fallen forwards and laid the arm on the table.
  for (int step = 1; step <= 40; ++step) {
    s.time = 0.01 * step;
    s.axes_reached[1] = machine.chain().kinematics.home[1] + from_deg(2.0 * step);
    s.X_WT = machine.X_WB *
             kinematics::forward(machine.chain().kinematics.chain, std::span(s.axes_reached).first(6));
    observer.observe(s);
  }
  bool link = false;
  for (const Contact& contact : observer.collisions())
    link = link || contact.body == "forearm" || contact.body == "wrist" || contact.body == "elbow";
  EXPECT_TRUE(link);
}

// The ends of both rods of a pair: at the carriage's height and the tool's, both as far out as the joints on
// the tool are, and to either side.
TEST(ChainBodies, RodsReachFromTheirCarriageToTheTool) {
  const auto machine = machine::load_machine("delta");
  ChainBodies bodies(machine, make_as_built(machine, "nominal", 1));
  const double height = 0.040, radius = 0.1344, rod = 0.267, out = 0.031, side = 0.023;
  const Vec3 tip(0.03, -0.05, 0.02), tower(0, radius, 0);  // c, behind the middle
  const Pose X_WT = machine.X_WB * make_pose(Quat::Identity(), tip);
  AxisVector axes{};
  ASSERT_EQ(machine.make_mechanism()->inverse(X_WT, {}, axes), kinematics::SolveStatus::ok);
  EXPECT_NEAR(axes[2], tip.z() + height + std::sqrt(rod * rod - (tip - tower).head<2>().squaredNorm()),
              1e-12);
  bodies.pose(axes);
  int found = 0;
  for (std::size_t i = 0; i < bodies.items().size(); ++i) {
    const auto& item = bodies.items()[i];
    if (item.shape.name != "rod c") continue;
    const auto& capsule = std::get<geometry::Capsule>(item.shape.form);
    EXPECT_NEAR(capsule.length, rod, 1e-15);
    const Vec3 low = bodies.place(i) * Vec3(0, 0, -rod / 2), high = bodies.place(i) * Vec3(0, 0, rod / 2);
    const Vec3 to_side(found == 0 ? side : -side, 0, 0);
    EXPECT_LE((low - (tip + Vec3(0, out, height) + to_side)).norm(), 1e-11);
    EXPECT_LE((high - (tower + Vec3(0, out, axes[2]) + to_side)).norm(), 1e-11);
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST(ChainBodies, NoPointOfARodMovesFartherThanItsSlideAndTheTipTogether) {
  const auto machine = machine::load_machine("delta");
  const auto mechanism = machine.make_mechanism();
  ChainBodies bodies(machine, make_as_built(machine, "nominal", 1));
  Random random(9, "rods");
  double tightest = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 from(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), random.uniform(0, 0.2));
    const Vec3 to = from + Vec3(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), 0);
    AxisVector a{}, b{}, travel{};
    ASSERT_EQ(mechanism->inverse(make_pose(Quat::Identity(), from), {}, a), kinematics::SolveStatus::ok);
    ASSERT_EQ(mechanism->inverse(make_pose(Quat::Identity(), to), {}, b), kinematics::SolveStatus::ok);
    for (std::size_t i = 0; i < 3; ++i) travel[i] = std::abs(a[i] - b[i]);
    for (std::size_t i = 0; i < bodies.items().size(); ++i) {
      if (bodies.items()[i].rod < 0) continue;
      bodies.pose(a);
      const Pose X_from = bodies.place(i);
      bodies.pose(b);
      const Pose X_to = bodies.place(i);
      const double bound = bodies.motion(i, travel, (to - from).norm());
      for (const double end : {-0.1335, 0.1335}) {
        const double motion = (X_to * Vec3(0, 0, end) - X_from * Vec3(0, 0, end)).norm();
        ASSERT_LE(motion, bound + 1e-12);
        tightest = std::max(tightest, motion / bound);
      }
    }
  }
  EXPECT_GT(tightest, 0.5);
}

}  // namespace
}  // namespace understudy::sim
