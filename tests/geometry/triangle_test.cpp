#include "geometry/triangle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::geometry {
namespace {

const Vec3 kA(0, 0, 0), kB(4, 0, 0), kC(0, 3, 0);

Vec3 random_vector(Random& random, double size) { return uniform_vec3(random, size); }

Vec3 point_of(const Vec3& barycentric, const Vec3& a, const Vec3& b, const Vec3& c) {
  return barycentric.x() * a + barycentric.y() * b + barycentric.z() * c;
}

TEST(Triangle, NearestPointIsOnTheFeatureWhoseRegionHoldsThePoint) {
  const struct {
    Vec3 p, nearest;
    Feature feature;
  } cases[] = {
      {{1, 1, 5}, {1, 1, 0}, Feature::inside},   {{-1, -2, 1}, {0, 0, 0}, Feature::corner0},
      {{6, -1, 0}, {4, 0, 0}, Feature::corner1}, {{-1, 7, 2}, {0, 3, 0}, Feature::corner2},
      {{2, -3, 1}, {2, 0, 0}, Feature::edge0},   {{2 + 3, 1.5 + 4, 0}, {2, 1.5, 0}, Feature::edge1},
      {{-5, 1, 0}, {0, 1, 0}, Feature::edge2},
  };
  for (const auto& c : cases) {
    const TrianglePoint found = nearest_on_triangle(c.p, kA, kB, kC);
    EXPECT_EQ(found.feature, c.feature) << c.p.transpose();
    EXPECT_LE((point_of(found.barycentric, kA, kB, kC) - c.nearest).norm(), 1e-14) << c.p.transpose();
    EXPECT_NEAR(found.barycentric.sum(), 1, 1e-15);
  }
}

TEST(Triangle, NoPointOfAFineGridIsNearer) {
  Random random(1, "nearest on triangle");
  constexpr int kGrid = 60;
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = random_vector(random, 1), b = random_vector(random, 1), c = random_vector(random, 1);
    const Vec3 p = random_vector(random, 2);
    const double distance = (point_of(nearest_on_triangle(p, a, b, c).barycentric, a, b, c) - p).norm();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kGrid; ++i)
      for (int j = 0; i + j <= kGrid; ++j) {
        const Vec3 w(i, j, kGrid - i - j);
        least = std::min(least, (point_of(w / kGrid, a, b, c) - p).norm());
      }
    EXPECT_LE(distance, least + 1e-12) << "triangle " << n;
    EXPECT_GE(distance, least - 4.0 / kGrid) << "triangle " << n;  // sides are up to 3.5 long
  }
}

TEST(WatertightRay, HitsAtTheDistanceOfThePlane) {
  const WatertightRay ray(Vec3(1, 1, 7), -Vec3::UnitZ());
  const auto hit = ray.hit(kA, kB, kC);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 7, 1e-14);
  EXPECT_LE((point_of(hit->barycentric, kA, kB, kC) - Vec3(1, 1, 0)).norm(), 1e-14);
  EXPECT_TRUE(ray.hit(kA, kC, kB)) << "from behind as well";
  EXPECT_FALSE(WatertightRay(Vec3(1, 1, 7), Vec3::UnitZ()).hit(kA, kB, kC)) << "it lies behind the origin";
  EXPECT_FALSE(WatertightRay(Vec3(3, 3, 7), -Vec3::UnitZ()).hit(kA, kB, kC)) << "beside it";
}

TEST(WatertightRay, NoRayPassesBetweenTrianglesThatShareAnEdge) {
  Random random(2, "watertight");
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a = random_vector(random, 1), b = random_vector(random, 1);
    const Vec3 left = random_vector(random, 1), right = a + b - left;  // so that the edge is their border
    const Vec3 on_edge = a + random.uniform(0.01, 0.99) * (b - a);
    const Vec3 origin = on_edge + 3 * (b - a).cross(left - a).normalized() + random_vector(random, 1);
    const WatertightRay ray(origin, (on_edge - origin).normalized());
    EXPECT_TRUE(ray.hit(a, b, left) || ray.hit(a, right, b)) << "edge " << n;
  }
}

TEST(WatertightRay, EntersABoxAtItsNearFace) {
  const WatertightRay ray(Vec3(-2, 0.5, 0.5), Vec3::UnitX());
  EXPECT_NEAR(ray.entry(Vec3(0, 0, 0), Vec3(1, 1, 1), 10), 2, 1e-12);
  EXPECT_GT(ray.entry(Vec3(0, 2, 0), Vec3(1, 3, 1), 10), 10) << "it misses";
  EXPECT_GT(ray.entry(Vec3(0, 0, 0), Vec3(1, 1, 1), 1.5), 1.5) << "beyond its reach";
}

}  // namespace
}  // namespace understudy::geometry
