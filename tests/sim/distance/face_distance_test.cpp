#include "sim/distance/face_distance.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"
#include "sim/collision/fcl_world.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

const Vec3 kTable(0.15, 0.15, 0.005);  // [m], half of its sides

ConvexSolid nozzle() {
  return *convex_solid({"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()});
}

TEST(FaceDistance, ATiltedNozzleOverATableIsItsRimAway) {
  for (double tilt_deg = 0; tilt_deg <= 30; tilt_deg += 1) {
    const double tilt = from_deg(tilt_deg);
    const Pose X = make_pose(exp_rotation(Vec3(0.6, 0.8, 0) * tilt), Vec3(0.03, -0.02, 5.35e-3));
    const auto over = distance_over_face(nozzle(), X, kTable);
    ASSERT_TRUE(over) << tilt_deg;
    EXPECT_NEAR(over->distance, 0.35e-3 - 0.5e-3 * std::sin(tilt), 1e-12) << tilt_deg;
    EXPECT_NEAR(over->place_W.z(), 5e-3, 1e-15);
    EXPECT_LT((over->place_W - X.translation()).head<2>().norm(), 0.6e-3) << "under the rim";
  }
}

TEST(FaceDistance, BesideTheFaceOrInTheBoxThereIsNoAnswer) {
  const auto at = [](double x, double z) { return make_pose(Quat::Identity(), Vec3(x, 0, z)); };
  EXPECT_FALSE(distance_over_face(nozzle(), at(0.2, 6e-3), kTable)) << "beyond its edge";
  EXPECT_FALSE(distance_over_face(nozzle(), at(0, 4.9e-3), kTable)) << "in it";
  EXPECT_FALSE(distance_over_face(nozzle(), at(0, 0), kTable));
  const auto ball = *convex_solid({"", geometry::Sphere{2e-3}, Pose::Identity()});
  ASSERT_TRUE(distance_over_face(ball, at(0.16, 0), kTable)) << "beside a side";
  EXPECT_NEAR(distance_over_face(ball, at(0.16, 0), kTable)->distance, 8e-3, 1e-15);
  EXPECT_FALSE(distance_over_face(ball, at(0.151, 5e-3), kTable)) << "1 mm from an edge";
}

TEST(FaceDistance, AHullIsAsFarAwayAsTheBoxThatItIs) {
  const Vec3 size(4e-3, 6e-3, 8e-3);
  const HullCore hull{test::box_mesh(Vec3::Zero(), size)};
  const auto box = *convex_solid({"", geometry::Box{size}, Pose::Identity()});
  for (double tilt_deg = 0; tilt_deg <= 90; tilt_deg += 7) {
    const Pose X = make_pose(exp_rotation(Vec3(0.6, 0.8, 0) * from_deg(tilt_deg)), Vec3(0.03, -0.02, 20e-3));
    const auto one = distance_over_face(hull, X, kTable), other = distance_over_face(box, X, kTable);
    ASSERT_TRUE(one && other) << tilt_deg;
    EXPECT_NEAR(one->distance, other->distance, 1e-12) << tilt_deg;
  }
}

// FCL's round bodies are polytopes, off by at most 0.25 um or 0.01 % of the radius.
TEST(FaceDistance, IsWhatFclFinds) {
  Random random(7, "solids over a box");
  const geometry::Shape block{"", geometry::Box{Vec3(20e-3, 14e-3, 10e-3)}, Pose::Identity()};
  const Vec3 half(10e-3, 7e-3, 5e-3);
  int answered = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double r = 0.5e-3 + 2e-3 * random.uniform(), l = 1e-3 + 8e-3 * random.uniform();
    const std::array<decltype(geometry::Shape::form), 5> forms{
        geometry::Sphere{r}, geometry::Capsule{r, l}, geometry::Cylinder{r, l},
        geometry::Frustum{r / 3, r, l}, geometry::Box{Vec3(r, l, 2e-3)}};
    const geometry::Shape shape{"", forms[static_cast<std::size_t>(trial) % forms.size()], Pose::Identity()};
    const Vec3 turn = 3 * uniform_vec3(random, 1), place = 25e-3 * uniform_vec3(random, 1);
    const Pose X = make_pose(exp_rotation(turn), place);
    const auto over = distance_over_face(*convex_solid(shape), X, half);
    if (!over) continue;
    ++answered;
    FclWorld world;
    const int first = world.add(shape), second = world.add(block);
    const Separation fcl = world.distance(first, X, second, Pose::Identity());
    EXPECT_NEAR(over->distance, fcl.distance, 0.6e-6) << trial;
    EXPECT_LE((over->place_W.cwiseAbs() - half).maxCoeff(), 1e-12) << "on the box";
  }
  EXPECT_GT(answered, 400);
}

}  // namespace
}  // namespace understudy::sim
