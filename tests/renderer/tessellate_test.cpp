#include "renderer/tessellate.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/box_mesh.h"

namespace understudy::renderer {
namespace {

double volume(const Surface& s) {
  double sum = 0;
  for (const auto& [a, b, c] : s.triangles) {
    const auto v = [&](int i) { return s.vertices[static_cast<std::size_t>(i)]; };
    sum += v(a).dot(v(b).cross(v(c))) / 6;
  }
  return sum;
}

void expect_normals_outside(const Surface& s) {
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const auto v = [&](std::size_t k) { return s.vertices[static_cast<std::size_t>(s.triangles[t][k])]; };
    const Vec3 face = (v(1) - v(0)).cross(v(2) - v(0));
    for (const Vec3& n : s.corner_normals[t]) {
      EXPECT_NEAR(n.norm(), 1, 1e-12);
      if (face.norm() > 0) {
        EXPECT_GT(n.dot(face.normalized()), 0.9);
      }
    }
  }
}

TEST(Tessellate, EncloseTheVolumeOfThePrismThatTheyAre) {
  // A prism of n sides has n/2 sin(2 pi / n) r^2 instead of pi r^2.
  constexpr int n = 48;
  const double ratio = n / 2.0 * std::sin(2 * std::numbers::pi / n);
  const Surface cylinder = tessellate({"c", geometry::Cylinder{2, 5}}, n);
  EXPECT_NEAR(volume(cylinder), ratio * 4 * 5, 1e-9);
  const Surface cone = tessellate({"f", geometry::Frustum{1, 3, 4}}, n);
  EXPECT_NEAR(volume(cone), ratio * 4.0 / 3 * (1 + 3 + 9), 1e-9);
  EXPECT_NEAR(volume(tessellate({"b", geometry::Box{{2, 3, 5}}}, n)), 30, 1e-9);
  const double ball = 4.0 / 3 * std::numbers::pi;
  EXPECT_NEAR(volume(tessellate({"s", geometry::Sphere{1}}, 200)), ball, 1e-3 * ball);
  EXPECT_NEAR(volume(tessellate({"k", geometry::Capsule{1, 2}}, 200)), ball + 2 * std::numbers::pi, 1e-2);
  for (const Surface& s : {cylinder, cone}) expect_normals_outside(s);
}

TEST(Tessellate, KeepsTheEdgesOfAMeshSharpAndItsCurvesSmooth) {
  // A welded cube: averaged over vertices, its normals would lean 54 degrees.
  const Surface s = tessellate(*geometry::box_mesh(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(s.creases.size(), 12u);
  expect_normals_outside(s);
  for (const auto& corners : s.corner_normals) {
    for (const Vec3& n : corners) EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1, 1e-12);
  }
  // A pipe of 36 welded sides: the normals point away from its axis.
  std::vector<Vec3> ring;
  std::vector<std::array<int, 3>> sides;
  for (int i = 0; i < 36; ++i) {
    const double a = 2 * std::numbers::pi * i / 36;
    ring.emplace_back(std::cos(a), std::sin(a), 0);
    ring.emplace_back(std::cos(a), std::sin(a), 1);
    const int next = (i + 1) % 36;
    sides.push_back({2 * i, 2 * next, 2 * next + 1});
    sides.push_back({2 * i, 2 * next + 1, 2 * i + 1});
  }
  const Surface pipe = tessellate(geometry::Mesh(ring, sides));
  EXPECT_TRUE(pipe.creases.empty());
  for (std::size_t t = 0; t < pipe.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = pipe.vertices[static_cast<std::size_t>(pipe.triangles[t][k])];
      EXPECT_NEAR(pipe.corner_normals[t][k].dot(Vec3(p.x(), p.y(), 0)), 1, 1e-9);
    }
  }
}

}  // namespace
}  // namespace understudy::renderer
