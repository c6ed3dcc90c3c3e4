#include "sim/distance/gjk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "sim/distance/bead_core.h"
#include "sim/distance/convex_solid.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The stated accuracy: twice the duality gap of 1 nm.
constexpr double kStated = 2e-9;
const Triangle kFloor = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 2, 0)};

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

template <typename F>
double least_on_unit_interval(const F& f) {
  constexpr double kGolden = 0.3819660112501051;
  double a = 0, b = 1;
  for (int i = 0; i < 45; ++i) {  // 0.618^45 = 4e-10 of the triangle's side
    const double m = a + (b - a) * kGolden, n = b - (b - a) * kGolden;
    (f(m) < f(n) ? b : a) = f(m) < f(n) ? n : m;
  }
  return f(0.5 * (a + b));
}

// The distance to a point is convex, so is its least over a line: two golden sections, one in the other.
double slow_distance(const ConvexSolid& solid, const Triangle& t) {
  return least_on_unit_interval([&](double s) {
    return least_on_unit_interval([&](double r) {
      return std::max(0.0, signed_distance(solid, t[0] + s * (t[1] - t[0]) + r * (1 - s) * (t[2] - t[0])));
    });
  });
}

std::vector<ConvexSolid> solids() {
  return {*convex_solid({"", geometry::Frustum{0.5e-3, 3.5e-3, 6e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Cylinder{3e-3, 4e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Box{Vec3(6e-3, 4e-3, 3e-3)}, Pose::Identity()}),
          *convex_solid({"", geometry::Capsule{1e-3, 6e-3}, Pose::Identity()}),
          *convex_solid({"", geometry::Sphere{2e-3}, Pose::Identity()})};
}

Triangle raised(const Triangle& t, const Vec3& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

TEST(Gjk, APointsDistanceIsThatOfThePlaneAnEdgeOrACorner) {
  EXPECT_NEAR(distance_to_triangle(PointCore{}, raised(kFloor, Vec3(0, 0, -0.3)), kInfinity).distance, 0.3,
              kStated);
  EXPECT_NEAR(distance_to_triangle(PointCore{}, raised(kFloor, Vec3(0, 4, 4)), kInfinity).distance,
              std::hypot(3, 4), kStated)
      << "edge at y = 3";
  EXPECT_NEAR(distance_to_triangle(PointCore{}, raised(kFloor, Vec3(4, 5, 12)), kInfinity).distance,
              std::hypot(3, 4, 12), kStated)
      << "corner at (3, 4, 12)";
}

TEST(Gjk, AnUprightBoxOrFrustumOverAFloorIsAsFarAsItsLowestFace) {
  const BoxCore box{Vec3(0.1, 0.2, 0.3)};
  EXPECT_NEAR(distance_to_triangle(box, raised(kFloor, Vec3(0, 0, -0.5)), kInfinity).distance, 0.2, kStated);
  const FrustumCore frustum{0.1, 0.4, -0.25, 0.6};
  EXPECT_NEAR(distance_to_triangle(frustum, raised(kFloor, Vec3(0, 0, -0.5)), kInfinity).distance, 0.25,
              kStated);
}

TEST(Gjk, BodiesThatOverlapAreZeroApartAndShareThePoint) {
  const BoxCore box{Vec3(0.1, 0.2, 0.3)};
  const GjkResult result = distance_to_triangle(box, kFloor, kInfinity);
  EXPECT_EQ(result.distance, 0);
  EXPECT_LE(result.on_other.cwiseAbs().cwiseQuotient(box.half).maxCoeff(), 1 + 1e-9);
  EXPECT_NEAR(result.on_other.z(), 0, 1e-12);
}

TEST(Gjk, StopsEarlyOnlyWhereTheDistanceIsNotBelowEnough) {
  Random random(3, "enough");
  for (int n = 0; n < 300; ++n) {
    const Triangle t = raised(kFloor, random_vector(random, 4));
    const double whole = distance_to_triangle(BoxCore{Vec3(0.3, 0.2, 0.1)}, t, kInfinity).distance;
    const double enough = random.uniform(0, 5);
    const double early = distance_to_triangle(BoxCore{Vec3(0.3, 0.2, 0.1)}, t, enough).distance;
    if (whole < enough - kStated) {
      EXPECT_NEAR(early, whole, kStated);
    }
    if (whole > enough + kStated) {
      EXPECT_GE(early, enough - kStated);
    }
  }
}

TEST(Gjk, ABeadsCoreIsAsFarFromAPointAsItsNearestPoint) {
  Random random(4, "bead cores");
  for (int n = 0; n < 300; ++n) {
    BeadCore bead;
    bead.middle = random_vector(random, 3);
    bead.half_along = random_vector(random, 1);
    bead.half_side = 0.1 * bead.half_along.unitOrthogonal();
    bead.up = bead.half_side.cross(bead.half_along).normalized();
    EXPECT_NEAR(distance_to_bead_core(PointCore{}, bead, kInfinity).distance,
                bead.nearest(Vec3::Zero()).norm(), kStated);
  }
}

TEST(Gjk, AgreesWithNestedGoldenSectionsOnRandomTriangles) {
  Random random(11, "gjk");
  for (int trial = 0; trial < 600; ++trial) {
    const auto all = solids();
    ConvexSolid solid = all[static_cast<std::size_t>(trial) % all.size()];
    solid.radius = 0;  // the core alone
    const double size = trial % 3 == 0 ? 0.3e-3 : trial % 3 == 1 ? 3e-3 : 30e-3;
    const Vec3 at = random_vector(random, 8e-3);
    Triangle t;
    for (Vec3& corner : t) corner = at + random_vector(random, size);
    const GjkResult result =
        std::visit([&](const auto& core) { return distance_to_triangle(core, t, kInfinity); }, solid.core);
    EXPECT_NEAR(result.distance, slow_distance(solid, t), kStated) << "trial " << trial;
    EXPECT_NEAR(std::max(0.0, signed_distance(solid, result.on_other)), result.distance, kStated);
    EXPECT_LT(result.iterations, 60) << "trial " << trial;
  }
}

}  // namespace
}  // namespace understudy::sim
