#include "sim/collision/fcl_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random_vector.h"
#include "core/units.h"
#include "sim/distance/penetration.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

// Distance of two segments by brute force over one and projection on the other, refined.
double segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto at = [&](double s) {
    const Vec3 p = a + s * (b - a);
    return (p - c - std::clamp((p - c).dot(d - c) / (d - c).squaredNorm(), 0.0, 1.0) * (d - c)).norm();
  };
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {  // convex in s
    const double m = low + (high - low) / 3, n = high - (high - low) / 3;
    (at(m) < at(n) ? high : low) = at(m) < at(n) ? n : m;
  }
  return at(0.5 * (low + high));
}

TEST(FclWorld, CapsulesAreTheirSegmentsApartLessTheRadii) {
  FclWorld world;
  const int first = world.add({"", geometry::Capsule{4e-3, 0.1}, Pose::Identity()});
  const int second = world.add({"", geometry::Capsule{3e-3, 0.1}, Pose::Identity()});
  Random random(1, "capsules");
  for (int trial = 0; trial < 500; ++trial) {
    std::array<Vec3, 4> p;
    for (Vec3& point : p) point = random_vector(random, 0.1);
    world.set_capsule_length(first, (p[1] - p[0]).norm());
    world.set_capsule_length(second, (p[3] - p[2]).norm());
    const auto a = geometry::capsule_between("", p[0], p[1], 4e-3),
               b = geometry::capsule_between("", p[2], p[3], 3e-3);
    const double expected = segment_distance(p[0], p[1], p[2], p[3]) - 7e-3;
    // FCL's closed form on the cores; ternary search ends at 1e-16 of the length.
    EXPECT_NEAR(world.distance(first, a.X_FS, second, b.X_FS).distance, expected, 1e-9) << "trial " << trial;
  }
}

TEST(FclWorld, TiltedNozzleOverTheTableIsARimAway) {
  FclWorld world;
  const int nozzle = world.add({"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()});
  const int table = world.add({"", geometry::Box{Vec3(0.3, 0.3, 0.01)}, Pose::Identity()});
  const Pose X_WTable = make_pose(Quat::Identity(), Vec3(0, 0, -5e-3));
  for (double tilt_deg = 0; tilt_deg <= 30; tilt_deg += 1) {
    const double tilt = from_deg(tilt_deg);
    const Pose X = make_pose(exp_rotation(Vec3(0.6, 0.8, 0) * tilt), Vec3(0.03, -0.02, 0.35e-3));
    const Separation s = world.distance(nozzle, X, table, X_WTable);
    // The polytope's stated accuracy.
    EXPECT_NEAR(s.distance, 0.35e-3 - 0.5e-3 * std::sin(tilt), 0.5e-6) << tilt_deg;
    EXPECT_NEAR(s.place_W.z(), 0, 1e-9);
  }
}

TEST(FclWorld, MeshesOfBoxesAreAsFarApartAsTheBoxes) {
  FclWorld world;
  const int first = world.add(
      {"", geometry::MeshShape{test::box_mesh(Vec3::Zero(), Vec3(2e-3, 2e-3, 2e-3))}, Pose::Identity()});
  const int second = world.add(
      {"", geometry::MeshShape{test::box_mesh(Vec3::Zero(), Vec3(4e-3, 4e-3, 4e-3))}, Pose::Identity()});
  const Mat3 turn = exp_rotation(Vec3(0, 0, 0.3));
  const Pose X1 = make_pose(turn, turn * Vec3(0.2e-3, 0.1e-3, 8e-3)), X2 = make_pose(turn, Vec3::Zero());
  const Separation s = world.distance(first, X1, second, X2);
  EXPECT_NEAR(s.distance, 5e-3, 1e-9);
  EXPECT_NEAR(s.place_W.z(), 2e-3, 1e-9);
}

TEST(FclWorld, OverlapIsNotPositive) {
  FclWorld world;
  const int nozzle = world.add({"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()});
  const int table = world.add({"", geometry::Box{Vec3(0.3, 0.3, 0.01)}, Pose::Identity()});
  const int part = world.add(
      {"", geometry::MeshShape{test::box_mesh(Vec3::Zero(), Vec3(2e-3, 2e-3, 2e-3))}, Pose::Identity()});
  const Pose X = make_pose(Quat::Identity(), Vec3(0, 0, 0.9e-3));
  EXPECT_LE(world.distance(nozzle, X, part, Pose::Identity()).distance, 0);
  EXPECT_LE(world.distance(nozzle, X, table, Pose::Identity()).distance, 0);
}

TEST(Penetration, FlatPressedIntoTheTopIsAsDeepAsItIsLow) {
  const geometry::Shape nozzle{"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()};
  const geometry::Shape part{
      "", geometry::MeshShape{test::box_mesh(Vec3(0, 0, -5e-3), Vec3(0.04, 0.04, 0.01))}, Pose::Identity()};
  const geometry::Shape table{"", geometry::Box{Vec3(0.3, 0.3, 0.01)}, Pose::Identity()};
  const Pose X_WTable = make_pose(Quat::Identity(), Vec3(0, 0, -5e-3));
  for (const double tilt : {0.0, 0.2, 0.5}) {
    const Pose X = make_pose(exp_rotation(Vec3(0, tilt, 0)), Vec3(0, 0, -0.1e-3));
    const double deepest = 0.1e-3 + 0.5e-3 * std::sin(tilt);
    // The rim is sampled: at most 0.2 % of its radius is missed.
    EXPECT_NEAR(penetration(nozzle, X, part, Pose::Identity()).depth, deepest, 1e-6);
    EXPECT_NEAR(penetration(nozzle, X, table, X_WTable).depth, deepest, 1e-6);
    EXPECT_NEAR(penetration(nozzle, X, table, X_WTable).place_W.z(), -deepest, 1e-6);
  }
}

TEST(Penetration, APinInTheMiddleOfAFlatIsFound) {
  const geometry::Shape block{"", geometry::Box{Vec3(16e-3, 16e-3, 10e-3)}, Pose::Identity()};
  const geometry::Shape pin{
      "", geometry::MeshShape{test::box_mesh(Vec3(1e-3, 1e-3, -5e-3), Vec3(1e-4, 1e-4, 1e-3))},
      Pose::Identity()};
  const Pose X = Pose::Identity();
  EXPECT_NEAR(penetration(block, X, pin, X).depth, 0.5e-3, 1e-9);
}

}  // namespace
}  // namespace understudy::sim
