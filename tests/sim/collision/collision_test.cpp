#include "sim/collision/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

constexpr double kHomeHeight = 0.05;

Snapshot at(double time, const Vec3& tip, int line = 1, const Mat3& R = Mat3::Identity()) {
  Snapshot s;
  s.time = time;
  s.X_WT = make_pose(R, tip);
  s.line = line;
  return s;
}

CollisionObserver watch(const std::shared_ptr<const geometry::Mesh>& part,
                        const CollisionOptions& options = {}) {
  const auto machine = test::hexapod();
  return CollisionObserver(machine, test::as_designed(machine), part, options);
}

const Contact* find(const std::vector<Contact>& contacts, const std::string& body,
                    const std::string& obstacle) {
  const auto found = std::find_if(contacts.begin(), contacts.end(),
                                  [&](const Contact& c) { return c.body == body && c.obstacle == obstacle; });
  return found == contacts.end() ? nullptr : &*found;
}

TEST(CollisionObserver, AThinWallBetweenTwoSnapshotsIsFound) {
  const auto wall = test::box_mesh(Vec3(15e-3, 0, 0.05), Vec3(0.05e-3, 0.02, 0.01));
  auto observer = watch(wall);
  observer.observe(at(0, Vec3(0, 0, kHomeHeight)));
  observer.observe(at(1, Vec3(30e-3, 0, kHomeHeight), 7));
  const auto contacts = observer.collisions();
  const Contact* hit = find(contacts, "nozzle", "part");
  ASSERT_NE(hit, nullptr);
  EXPECT_EQ(hit->line, 7);
  // While the cone, 3.4 mm wide at the wall's top, passes it.
  EXPECT_NEAR(hit->time, 0.5, 2 * 3.4 / 30);
  EXPECT_LE(hit->clearance, 0);

  for (const double x : {0.0, 30e-3}) {
    auto at_rest = watch(wall);
    at_rest.observe(at(0, Vec3(x, 0, kHomeHeight)));
    EXPECT_TRUE(at_rest.collisions().empty()) << "the two snapshots alone are clear";
  }
}

TEST(CollisionObserver, TheWorkingGapIsNoCollisionAndTouchingIs) {
  const auto plate = test::box_mesh(Vec3(0, 0, kHomeHeight - 5e-3), Vec3(0.06, 0.06, 0.01));
  for (const double gap : {0.1e-3, 1e-6}) {
    auto observer = watch(plate);
    observer.observe(at(0, Vec3(-5e-3, 0, kHomeHeight + gap)));
    observer.observe(at(1, Vec3(5e-3, 0, kHomeHeight + gap)));
    EXPECT_TRUE(observer.collisions().empty()) << gap;
    EXPECT_TRUE(observer.near_collisions().empty()) << gap;
    EXPECT_NEAR(observer.min_nozzle_clearance(), gap, 2e-9);
    EXPECT_GT(observer.min_clearance(), 5e-3) << "the nozzle's gap is not in the least clearance";
  }
  auto observer = watch(plate);
  observer.observe(at(0, Vec3(0, 0, kHomeHeight + 0.1e-3)));
  observer.observe(at(1, Vec3(0, 0, kHomeHeight - 0.03e-3), 12));
  ASSERT_EQ(observer.collisions().size(), 1u);
  EXPECT_EQ(observer.collisions().front().body, "nozzle");
  EXPECT_EQ(observer.collisions().front().line, 12);
}

TEST(CollisionObserver, NozzleContactRaisesWhatCountsAsTouching) {
  const auto plate = test::box_mesh(Vec3(0, 0, kHomeHeight - 5e-3), Vec3(0.06, 0.06, 0.01));
  CollisionOptions options;
  options.nozzle_contact = 0.05e-3;
  for (const double gap : {0.051e-3, 0.049e-3}) {
    auto observer = watch(plate, options);
    observer.observe(at(0, Vec3(0, 0, kHomeHeight + gap)));
    EXPECT_EQ(observer.collisions().size(), gap < options.nozzle_contact ? 1u : 0u);
  }
}

TEST(CollisionObserver, EveryLineNamesItsDeepestContactOnce) {
  const auto plate = test::box_mesh(Vec3(0, 0, kHomeHeight - 5e-3), Vec3(0.06, 0.06, 0.01));
  auto observer = watch(plate);
  const auto height = [](double x) { return kHomeHeight - 0.2e-3 * std::exp(-x * x / 4e-6); };
  for (int i = 0; i <= 400; ++i) {
    const double x = (i - 200) * 25e-6;
    observer.observe(at(i * 1e-3, Vec3(x, 0, height(x)), i < 300 ? 3 : 4));
  }
  const auto contacts = observer.collisions();
  ASSERT_EQ(contacts.size(), 2u);
  // Depths are within a margin of the deepest of the line; here 0.2 mm, and that at x = 2.5 mm.
  EXPECT_EQ(contacts[0].line, 3);
  EXPECT_NEAR(contacts[0].clearance, -0.2e-3, 2e-5);
  EXPECT_EQ(contacts[1].line, 4);
  EXPECT_NEAR(contacts[1].clearance, height(2.475e-3) - kHomeHeight, 2e-5);
}

TEST(CollisionObserver, AShallowContactAfterADeepOneIsFoundOnItsOwnLine) {
  const auto plate = test::box_mesh(Vec3(0, 0, kHomeHeight - 5e-3), Vec3(0.06, 0.06, 0.01));
  auto observer = watch(plate);
  const auto above = [](double height) { return Vec3(0, 0, kHomeHeight + height); };
  observer.observe(at(0, above(5e-3), 1));
  observer.observe(at(1, above(-0.5e-3), 1));
  observer.observe(at(2, above(5e-3), 1));
  observer.observe(at(3, above(-0.05e-3), 2));
  observer.observe(at(4, above(5e-3), 2));
  const auto contacts = observer.collisions();
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].clearance, -0.5e-3, 0.025e-3);
  EXPECT_EQ(contacts[1].line, 2);
  EXPECT_NEAR(contacts[1].clearance, -0.05e-3, 0.02001e-3);
}

TEST(CollisionObserver, ANozzleThatStartsInsideThePartIsFound) {
  const auto block = test::box_mesh(Vec3(0, 0, 0.05), Vec3(0.2, 0.2, 0.2));
  auto observer = watch(block);
  observer.observe(at(0, Vec3(0, 0, kHomeHeight)));
  const auto contacts = observer.collisions();
  const Contact* hit = find(contacts, "nozzle", "part");
  ASSERT_NE(hit, nullptr);
  // The deepest point of the nozzle's surface is the tip, 100 mm below the top.
  EXPECT_NEAR(hit->clearance, -0.1, 1e-9);
  EXPECT_NE(find(contacts, "heater block", "part"), nullptr);
}

TEST(CollisionObserver, ABodyOtherThanTheNozzleIsNearBeforeItHits) {
  // A post whose top is 0.3 mm below the heater block, 6 mm beside the axis.
  const auto post =
      test::box_mesh(Vec3(6e-3, 0, kHomeHeight + 12e-3 - 0.3e-3 - 5e-3), Vec3(1e-3, 1e-3, 10e-3));
  auto observer = watch(post);
  observer.observe(at(0, Vec3(0, 0, kHomeHeight), 5));
  observer.observe(at(1, Vec3(0, 1e-3, kHomeHeight), 5));
  EXPECT_TRUE(observer.collisions().empty());
  const auto near = observer.near_collisions();
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0].body, "heater block");
  EXPECT_NEAR(near[0].clearance, 0.3e-3, 2e-9);
  EXPECT_NEAR(observer.min_clearance(), 0.3e-3, 2e-9);
  EXPECT_EQ(observer.closest().body, "heater block");

  observer.observe(at(1.5, Vec3(0, 1.01e-3, kHomeHeight), 6));
  ASSERT_EQ(observer.near_collisions().size(), 2u) << "each line has its own entry, however little it moves";
  EXPECT_EQ(observer.near_collisions()[1].line, 6);

  observer.observe(at(2, Vec3(0, 1e-3, kHomeHeight - 0.4e-3), 6));
  EXPECT_EQ(observer.near_collisions().size(), 1u) << "line 6 has the collision now";
  const auto hits = observer.collisions();
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_NEAR(hits[0].clearance, -0.1e-3, 2.001e-5) << "within the margin of the end";
}

TEST(CollisionObserver, StrutsHaveTheAsBuiltGeometry) {
  const auto machine = test::hexapod();
  auto as_built = test::as_designed(machine);
  const Pose X_WT = make_pose(Quat::Identity(), Vec3(0, 0, kHomeHeight));
  const Vec3 base = machine.X_WB * machine.hexapod().geometry.base_joint[0],
             ball = X_WT * machine.hexapod().geometry.platform_joint[0];
  const Vec3 middle = 0.5 * (base + ball), along = (ball - base).normalized();
  const Vec3 beside =
      along.cross(Vec3(0, 0, 1)).normalized() * (middle.head<2>().dot(along.head<2>()) > 0 ? 1 : 1);
  // A small box 0.6 mm clear of the nominal strut's side.
  Mat3 R;
  R.col(0) = beside;
  R.col(1) = along;
  R.col(2) = beside.cross(along);
  const auto box = test::box_mesh(middle + beside * (4e-3 + 0.6e-3 + 0.5e-3), Vec3(1e-3, 1e-3, 1e-3), R);
  CollisionObserver nominal(machine, as_built, box, {});
  nominal.observe(at(0, X_WT.translation()));
  EXPECT_EQ(find(nominal.collisions(), "strut 1", "part"), nullptr);
  EXPECT_NEAR(nominal.min_clearance(), 0.6e-3, 2e-9);

  as_built.hexapod.base_joint[0] += 2e-3 * beside;  // 1 mm at the middle
  CollisionObserver built(machine, as_built, box, {});
  built.observe(at(0, X_WT.translation()));
  const auto contacts = built.collisions();
  const Contact* hit = find(contacts, "strut 1", "part");
  ASSERT_NE(hit, nullptr);
  // The strut turned by 2 mm over 189 mm: 1 % of the shift.
  EXPECT_NEAR(hit->clearance, -0.4e-3, 0.02e-3);
}

TEST(CollisionObserver, EveryPairIsWatchedButStrutAndPlatform) {
  // 3 tool bodies and 6 struts against part and table, 15 pairs of struts, 6 struts against nozzle and block.
  EXPECT_EQ(watch(test::box_mesh(Vec3(0.1, 0.1, 0.01), Vec3(0.01, 0.01, 0.01))).pairs(), 9 * 2 + 15 + 12);
  EXPECT_EQ(watch(nullptr).pairs(), 9 + 15 + 12);
}

// At home the ball joints of a pair are 2 * 29 mm * sin(17 deg) apart, and there the struts are closest.
TEST(CollisionObserver, LeastClearanceAtHomeIsThatOfTwoBallJoints) {
  auto observer = watch(nullptr);
  observer.observe(at(0, Vec3(0, 0, kHomeHeight)));
  EXPECT_NEAR(observer.min_clearance(), 2 * 29e-3 * std::sin(from_deg(17)) - 8e-3, 1e-9);
  EXPECT_NEAR(observer.min_nozzle_clearance(), kHomeHeight, 1e-9) << "to the table, there is no part";
}

TEST(CollisionObserver, TheTableIsAnObstacle) {
  auto observer = watch(nullptr);
  observer.observe(at(0, Vec3(0, 0, 20e-3)));
  observer.observe(at(1, Vec3(0, 0, -0.2e-3), 9));
  const auto contacts = observer.collisions();
  const Contact* hit = find(contacts, "nozzle", "table");
  ASSERT_NE(hit, nullptr);
  EXPECT_NEAR(hit->clearance, -0.2e-3, 0.02e-3);
  EXPECT_NEAR(hit->place_W.z(), hit->clearance, 1e-9);
}

TEST(CollisionObserver, ACutterMayTouchThePartAndNothingElse) {
  const auto block = test::box_mesh(Vec3(0, 0, 20e-3), Vec3(10e-3, 10e-3, 10e-3));
  for (const bool cuts : {false, true}) {
    CollisionOptions options;
    if (cuts) options.cutter = "nozzle";
    auto observer = watch(block, options);
    observer.observe(at(0, Vec3(0, 0, 40e-3)));
    observer.observe(at(1, Vec3(0, 0, 22e-3), 2));
    observer.observe(at(2, Vec3(0, 0, -0.2e-3), 3));
    EXPECT_EQ(find(observer.collisions(), "nozzle", "part") == nullptr, cuts);
    EXPECT_NE(find(observer.collisions(), "nozzle", "table"), nullptr);
    EXPECT_NE(find(observer.collisions(), "platform", "part"), nullptr) << "what holds it may not";
  }
}

TEST(CollisionObserver, StandingStillAndFarFlightsCostFewChecks) {
  const auto part = test::bottle_mesh(Vec3(0, 0, 15.5e-3), 15.5e-3, 0.06, 96, 40);
  auto observer = watch(part);
  observer.observe(at(0, Vec3(-20e-3, 0, 0.08)));
  const auto first = observer.checks();
  EXPECT_EQ(first, static_cast<std::uint64_t>(observer.pairs()));
  for (int i = 1; i <= 1000; ++i) observer.observe(at(i * 1e-3, Vec3(-20e-3, 0, 0.08)));
  EXPECT_EQ(observer.checks(), first);
  // 40 mm at 40 mm/s, 49 mm above the bottle, seen at 1 kHz: the struts' 9 mm must be looked at every
  // 0.09 mm of their own motion, and nothing else often.
  for (int i = 1; i <= 1000; ++i) observer.observe(at(1 + i * 1e-3, Vec3(-20e-3 + i * 40e-6, 0, 0.08)));
  EXPECT_LT(observer.checks() - first, 5000u);
}

TEST(CollisionObserver, TheSameRunTwiceGivesTheSameAnswers) {
  const auto part = test::bottle_mesh(Vec3(0, 0, 34.4e-3), 15.5e-3, 0.06, 96, 40);
  auto one = watch(part), two = watch(part);
  for (int i = 0; i <= 200; ++i) {
    const double angle = from_deg(-20 + i * 0.2);
    const Vec3 normal(std::sin(angle), 0, std::cos(angle));
    const Snapshot s =
        at(i * 1e-2, Vec3(0, 0, 34.4e-3) + 15.6e-3 * normal, i, exp_rotation(Vec3(0, angle, 0)));
    one.observe(s);
    two.observe(s);
  }
  EXPECT_EQ(one.min_clearance(), two.min_clearance());
  EXPECT_EQ(one.min_nozzle_clearance(), two.min_nozzle_clearance());
  EXPECT_EQ(one.checks(), two.checks());
  EXPECT_EQ(one.closest().time, two.closest().time);
}

TEST(CollisionObserver, APoseThatIsNotFiniteIsTheEnginesFailure) {
  auto observer = watch(nullptr);
  EXPECT_THROW(observer.observe(at(0, Vec3(0, 0, std::numeric_limits<double>::quiet_NaN()))), MachineError);
}

TEST(CollisionObserver, AMarginThatIsNotPositiveIsRefused) {
  CollisionOptions options;
  options.margin = 0;
  EXPECT_THROW(watch(nullptr, options), InputError);
}

}  // namespace
}  // namespace understudy::sim
