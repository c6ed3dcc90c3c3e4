#include "sim/distance/mesh_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random_vector.h"
#include "core/units.h"
#include "sim/collision/fcl_world.h"
#include "sim/distance/gjk.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The stated accuracy: twice GJK's duality gap of 1 nm.
constexpr double kStated = 2e-9;

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

Mat3 random_rotation(Random& random) {
  return Quat(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

std::vector<ConvexSolid> solids() {
  return {*convex_solid({"", geometry::Frustum{0.5e-3, 3.5e-3, 6e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Cylinder{3e-3, 4e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Box{Vec3(6e-3, 4e-3, 3e-3)}, Pose::Identity()}),
          *convex_solid({"", geometry::Capsule{1e-3, 6e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Sphere{2e-3}, Pose::Identity()})};
}

// A tilted cone over a plane stands on its rim: height - r sin(tilt).
TEST(MeshClearance, TiltedNozzleOverAPlaneIsARimAway) {
  const MeshClearance plane(test::box_mesh(Vec3(0, 0, -5e-3), Vec3(0.1, 0.1, 0.01)));
  const auto nozzle = *convex_solid({"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()});
  for (double tilt_deg = 0; tilt_deg <= 30; tilt_deg += 2.5) {
    const double tilt = from_deg(tilt_deg), height = 0.35e-3;
    const Pose X = make_pose(exp_rotation(Vec3(0.6, 0.8, 0) * tilt), Vec3(1e-3, 2e-3, height));
    const Separation s = plane.distance(nozzle, X);
    EXPECT_NEAR(s.distance, height - 0.5e-3 * std::sin(tilt), kStated) << tilt_deg;
    EXPECT_NEAR(s.place_W.z(), 0, 1e-12);
  }
}

// Over a cylinder of radius R, tilted about the cylinder's axis by more than asin(r / (R + gap)), the flat's
// rim is nearest; the distance is that of a point to the axis.
TEST(MeshClearance, TiltedNozzleOverTheBottleMatchesTheCylinder) {
  constexpr double kRadius = 15.5e-3, kRim = 0.5e-3;
  constexpr int kAround = 720;
  const MeshClearance bottle(test::bottle_mesh(Vec3::Zero(), kRadius, 0.08, kAround, 40));
  const auto nozzle = *convex_solid({"", geometry::Frustum{kRim, 3.5e-3, 12e-3}, Pose::Identity()});
  // The polygon lies inside the cylinder by at most R (1 - cos(pi/n)) = 0.15 um.
  const double facet = kRadius * (1 - std::cos(M_PI / kAround));
  for (const double tilt_deg : {3.0, 5.0, 10.0, 20.0, 30.0}) {
    for (const double around_deg : {70.0, 90.0, 104.3}) {
      const double around = from_deg(around_deg), tilt = from_deg(tilt_deg), gap = 0.4e-3;
      const Vec3 normal(std::cos(around), 0, std::sin(around));
      const Mat3 R = exp_rotation(Vec3(0, tilt, 0)) * shortest_arc_from_z(normal).toRotationMatrix();
      const Vec3 tip = (kRadius + gap) * normal;
      double rim = kInfinity;
      for (const double side : {-1.0, 1.0}) {
        const Vec3 in_plane = R.col(2).cross(Vec3(0, 1, 0)).normalized();
        rim = std::min(rim, (tip + side * kRim * in_plane).norm() - kRadius);
      }
      const double d = bottle.distance(nozzle, make_pose(R, tip)).distance;
      EXPECT_GE(d, rim - kStated);
      EXPECT_LE(d, rim + facet + kStated);
    }
  }
}

TEST(MeshClearance, SearchFindsTheNearestOfAllTriangles) {
  const auto mesh = test::bottle_mesh(Vec3::Zero(), 15.5e-3, 0.04, 48, 20);
  const MeshClearance clearance(mesh);
  Random random(5, "search");
  for (int trial = 0; trial < 60; ++trial) {
    for (const ConvexSolid& solid : solids()) {
      const Pose X = make_pose(random_rotation(random), random_vector(random, 25e-3));
      double least = kInfinity;
      for (const auto& indices : mesh->triangles()) {
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k) {
          t[k] = X.inverse(Eigen::Isometry) * mesh->vertices()[static_cast<std::size_t>(indices[k])];
        }
        const auto one = std::visit(
            [&](const auto& core) { return distance_to_triangle(core, t, kInfinity); }, solid.core);
        least = std::min(least, one.distance);
      }
      EXPECT_NEAR(clearance.distance(solid, X).distance, least - solid.radius, kStated) << "trial " << trial;
    }
  }
}

// Two implementations that share nothing.
TEST(MeshClearance, AgreesWithFcl) {
  const auto mesh = test::bottle_mesh(Vec3::Zero(), 15.5e-3, 0.04, 48, 20);
  const MeshClearance clearance(mesh);
  const std::vector<geometry::Shape> shapes{{"", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()},
                                            {"", geometry::Cylinder{3e-3, 4e-3}, Pose::Identity()},
                                            {"", geometry::Box{Vec3(6e-3, 4e-3, 3e-3)}, Pose::Identity()},
                                            {"", geometry::Capsule{1e-3, 60e-3}, Pose::Identity()},
                                            {"", geometry::Sphere{2e-3}, Pose::Identity()}};
  FclWorld world;
  const int part = world.add({"part", geometry::MeshShape{mesh}, Pose::Identity()});
  Random random(6, "fcl");
  int apart = 0;
  for (const geometry::Shape& shape : shapes) {
    const int body = world.add(shape);
    const ConvexSolid solid = *convex_solid(shape);
    for (int trial = 0; trial < 100; ++trial) {
      const Pose X = make_pose(random_rotation(random), random_vector(random, 30e-3));
      const Separation ours = clearance.distance(solid, X),
                       theirs = world.distance(body, X, part, Pose::Identity());
      if (ours.distance <= 0 || theirs.distance <= 0) {
        EXPECT_LE(ours.distance, 0.5e-6);
        EXPECT_LE(theirs.distance, 0.5e-6);
        continue;
      }
      ++apart;
      EXPECT_NEAR(ours.distance, theirs.distance, 0.5e-6) << "FCL's round bodies are polytopes within 0.5 um";
      // Distance of FCL's place from the body: it is on the obstacle.
      EXPECT_NEAR(signed_distance(solid, X.inverse(Eigen::Isometry) * theirs.place_W), theirs.distance, 1e-6);
      EXPECT_NEAR(mesh->nearest(theirs.place_W).distance, 0, 1e-7);
    }
  }
  EXPECT_GT(apart, 200);
}

}  // namespace
}  // namespace understudy::sim
