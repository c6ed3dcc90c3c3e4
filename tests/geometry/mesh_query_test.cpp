#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <thread>

#include "core/random_vector.h"
#include "core/units.h"
#include "geometry/mesh.h"
#include "tests/geometry/test_solids.h"

namespace understudy::geometry {
namespace {

Mesh mesh_of(const Triangles& t) { return {t.vertices, t.triangles}; }

Vec3 random_point(Random& random, double half) { return uniform_vec3(random, half); }

Vec3 random_direction(Random& random) { return normal_vec3(random).normalized(); }

// Triangles thrown into a box: no shared edges, all sizes, many crossings.
Triangles random_soup(Random& random, int count) {
  Triangles t;
  for (int i = 0; i < count; ++i) {
    const Vec3 centre = random_point(random, 0.1);
    const double size = std::pow(10.0, random.uniform(-4, -1));
    for (int k = 0; k < 3; ++k) t.vertices.push_back(centre + random_point(random, size));
    t.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return t;
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + s * (b - a) - p).norm();
}

// The slow, obvious way: foot of the perpendicular if it falls inside, else the nearest of three segments.
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const bool inside = (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
                      (a - c).cross(p - c).dot(n) >= 0;
  if (inside) return std::abs((p - a).dot(n));
  return std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
}

std::optional<double> triangle_hit(const Vec3& o, const Vec3& d, const Vec3& a, const Vec3& b,
                                   const Vec3& c) {
  Mat3 m;
  m << -d, b - a, c - a;
  const Vec3 tuv = m.fullPivLu().solve(Vec3(o - a));
  if (tuv[0] < 0 || tuv[1] < 0 || tuv[2] < 0 || tuv[1] + tuv[2] > 1) return std::nullopt;
  return tuv[0];
}

TEST(MeshQuery, NearestAgreesWithASearchThroughEveryTriangle) {
  Random random(7, "nearest");
  const Triangles soup = random_soup(random, 600);
  const Mesh mesh = mesh_of(soup);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(random, 0.2);
    double expected = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : soup.triangles)
      expected = std::min(expected, triangle_distance(p, soup.vertices[static_cast<std::size_t>(a)],
                                                      soup.vertices[static_cast<std::size_t>(b)],
                                                      soup.vertices[static_cast<std::size_t>(c)]));
    const SurfacePoint found = mesh.nearest(p);
    // Rounding of coordinates of 0.2 m, times the conditioning of the thinnest random triangle.
    ASSERT_NEAR(found.distance, expected, 1e-13) << "p " << p.transpose();
    ASSERT_NEAR((found.position - p).norm(), found.distance, 1e-15);
  }
}

TEST(MeshQuery, RayHitAgreesWithASearchThroughEveryTriangle) {
  Random random(8, "ray");
  const Triangles soup = random_soup(random, 400);
  const Mesh mesh = mesh_of(soup);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = random_point(random, 0.2), direction = random_direction(random);
    const double reach = random.uniform(0.01, 0.5);
    std::optional<double> expected;
    for (const auto& [a, b, c] : soup.triangles) {
      const auto t = triangle_hit(origin, direction, soup.vertices[static_cast<std::size_t>(a)],
                                  soup.vertices[static_cast<std::size_t>(b)],
                                  soup.vertices[static_cast<std::size_t>(c)]);
      if (t && *t <= reach && (!expected || *t < *expected)) expected = t;
    }
    const auto found = mesh.ray_hit(origin, direction, reach);
    ASSERT_EQ(found.has_value(), expected.has_value()) << i;
    if (!found) continue;
    ++hits;
    ASSERT_NEAR(found->distance, *expected, 1e-12) << i;  // grazing hits lose three digits
    ASSERT_LT((origin + found->distance * direction - found->position).norm(), 1e-12);
  }
  EXPECT_GT(hits, 200);
}

TEST(MeshQuery, RaysAlongAnAxisAndFromTheSurfaceAreFound) {
  const Mesh cube = mesh_of(box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 out = side * Vec3::Unit(axis);
      const auto from_inside = cube.ray_hit(Vec3::Zero(), out, 5);
      ASSERT_TRUE(from_inside);
      EXPECT_DOUBLE_EQ(from_inside->distance, 1);
      EXPECT_EQ(from_inside->normal, out);
      const auto from_outside = cube.ray_hit(3 * out, -out, std::numeric_limits<double>::infinity());
      ASSERT_TRUE(from_outside);
      EXPECT_DOUBLE_EQ(from_outside->distance, 2);
      EXPECT_FALSE(cube.ray_hit(3 * out, -out, 1.999));
      EXPECT_FALSE(cube.ray_hit(3 * out, out, std::numeric_limits<double>::infinity()));
      EXPECT_DOUBLE_EQ(cube.ray_hit(out, -out, 5)->distance, 0);
    }
  }
}

TEST(MeshQuery, NoRaySlipsThroughAnEdgeOrAVertexOfAClosedSurface) {
  const Triangles ball = sphere(0.02, 40, 60);
  const Mesh mesh = mesh_of(ball);
  const Vec3 centre(1.3e-3, -0.7e-3, 2.1e-3);
  Random random(9, "edges");
  for (const auto& triangle : ball.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = ball.vertices[static_cast<std::size_t>(triangle[k])];
      const Vec3& b = ball.vertices[static_cast<std::size_t>(triangle[(k + 1) % 3])];
      for (const double s : {0.0, 0.5, random.uniform()}) {
        const Vec3 target = a + s * (b - a);
        const auto hit = mesh.ray_hit(centre, (target - centre).normalized(), 1);
        ASSERT_TRUE(hit) << target.transpose();
        ASSERT_NEAR(hit->distance, (target - centre).norm(), 1e-14);
      }
    }
  }
}

TEST(MeshQuery, SphereGivesItsClosedFormWithinTheSagOfItsFacets) {
  const double radius = 0.015;
  const int rings = 90, facets = 180;
  const Mesh mesh = mesh_of(sphere(radius, rings, facets));
  const double step = std::numbers::pi / rings;
  const double sag = radius * (1 - std::cos(step / 2) * std::cos(step / 2));  // both ways across a facet
  Random random(10, "sphere");
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = random_direction(random);
    const Vec3 p = random.uniform(0.2, 3) * radius * direction;
    const double closed_form = p.norm() - radius;
    ASSERT_NEAR(mesh.signed_distance(p), closed_form, sag + 1e-15);
    const auto hit = mesh.ray_hit(2 * radius * direction, -direction, 1);
    ASSERT_TRUE(hit);
    ASSERT_NEAR(hit->distance, radius, sag + 1e-15);
    // Unequal neighbours round the poles tilt a vertex normal by less than half a facet (2 deg).
    const double polar = std::acos(std::abs(direction.z()));
    ASSERT_LT(std::acos(std::min(1.0, hit->normal.dot(direction))), (polar < 0.2 ? 1.0 : 0.1) * kDegree);
  }
}

TEST(MeshQuery, CylinderNormalsAreRightUpToTheRimOfItsCaps) {
  const double radius = 0.0155, length = 0.07;
  const int facets = 360;
  const Mesh mesh = mesh_of(cylinder(radius, length, facets));
  // Interpolated between exact normals half a facet away: the cubic term of an arc, (h/2)^3 / 15 rad.
  const double half = std::numbers::pi / facets;
  const double tolerance = std::pow(half, 3) / 3;
  Random random(11, "cylinder");
  for (int i = 0; i < 2000; ++i) {
    const double phi = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 radial(std::cos(phi), std::sin(phi), 0);
    const double depth = i % 2 ? 1e-6 : random.uniform(0, length / 2);  // every other point next to the cap
    const SurfacePoint side = mesh.nearest(1.2 * radius * radial + (length / 2 - depth) * Vec3::UnitZ());
    // From afar the foot of the perpendicular on a facet is not at phi; its own normal is what is promised.
    const Vec3 at_foot = Vec3(side.position.x(), side.position.y(), 0).normalized();
    ASSERT_LT((side.normal - at_foot).norm(), tolerance);
    const auto hit = mesh.ray_hit(0.5 * radius * radial + (depth - length / 2) * Vec3::UnitZ(), radial, 1);
    ASSERT_LT((hit->normal - radial).norm(), tolerance);
    const double r = i % 2 ? radius * (1 - 1e-4) : random.uniform(0, radius * (1 - 1e-4));
    const SurfacePoint cap = mesh.nearest(r * radial + (length / 2 + 0.003) * Vec3::UnitZ());
    ASSERT_LT((cap.normal - Vec3::UnitZ()).norm(), 1e-15);
  }
}

TEST(MeshQuery, LongFacetsKeepTheirNormalBesideASmallFillet) {
  // A CAD cylinder: 70 mm of wall in one band, a 2 mm fillet in four, a flat bottom.
  const double radius = 0.0155, fillet = 0.002;
  std::vector<std::array<double, 2>> profile = {{0, 0}};
  for (int i = 0; i <= 4; ++i) {
    const double a = std::numbers::pi / 2 * i / 4;
    profile.push_back({fillet * (1 - std::cos(a)), radius - fillet * (1 - std::sin(a))});
  }
  profile.push_back({0.07, radius});
  profile.push_back({0.07, 0});
  const Mesh mesh = mesh_of(revolve(profile, 360));
  for (const double z : {0.0025, 0.01, 0.035}) {
    const Vec3 normal = mesh.nearest(Vec3(0.02, 0, z)).normal;
    EXPECT_LT(std::acos(normal.x()), 0.2 * kDegree) << z;  // half a fillet facet would be 5.6 deg
  }
}

// Distance to a box: the closed form.
double box_distance(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(MeshQuery, SignedDistanceOfABoxIsTheClosedFormEverywhere) {
  const Vec3 half(0.01, 0.02, 0.005);
  const Mesh mesh = mesh_of(box(-half, half));
  Random random(12, "box");
  for (int i = 0; i < 5000; ++i) {
    Vec3 p = random_point(random, 0.04);
    if (i % 3 == 0)
      p = p.cwiseSign().cwiseProduct(half) * random.uniform(0.5, 1.5);  // straight off the corners
    ASSERT_NEAR(mesh.signed_distance(p), box_distance(p, half), 1e-15) << p.transpose();
  }
}

TEST(MeshQuery, SignIsRightBesideASharpTip) {
  // Beside so sharp a tip the nearest point is the tip, and single face normals contradict one another.
  Triangles spike;
  spike.vertices = {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.001, 0), Vec3(-0.003, -0.004, 0.05)};
  spike.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const Mesh mesh = mesh_of(spike);
  ASSERT_GT(mesh.volume(), 0);
  Random random(13, "spike");
  int inside_count = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = spike.vertices[static_cast<std::size_t>(i % 4)] + random_point(random, 0.004);
    bool inside = true;
    for (const auto& [a, b, c] : spike.triangles) {
      const Vec3 &u = spike.vertices[static_cast<std::size_t>(a)],
                 &v = spike.vertices[static_cast<std::size_t>(b)],
                 &w = spike.vertices[static_cast<std::size_t>(c)];
      inside = inside && (v - u).cross(w - u).dot(p - u) < 0;
    }
    inside_count += inside;
    ASSERT_EQ(mesh.signed_distance(p) < 0, inside) << p.transpose();
  }
  EXPECT_GT(inside_count, 100);
}

TEST(MeshQuery, ThreadsSeeTheSameAnswers) {
  const Mesh mesh = mesh_of(sphere(0.02, 60, 120));
  const auto run = [&mesh] {
    Random random(14, "threads");
    double sum = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = random_point(random, 0.05);
      sum += mesh.signed_distance(p);
      if (const auto hit = mesh.ray_hit(p, random_direction(random), 1)) sum += hit->distance;
    }
    return sum;
  };
  double sums[2] = {0, 1};
  {
    std::thread one([&] { sums[0] = run(); }), other([&] { sums[1] = run(); });
    one.join();
    other.join();
  }
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], run());
}

}  // namespace
}  // namespace understudy::geometry
