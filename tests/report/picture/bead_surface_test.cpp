#include "report/picture/bead_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace understudy::report {
namespace {

/// A bead of 0.4 by 0.2 mm, 5 mm along x, and what a picture draws of it.
renderer::SmoothSurface drawn_bead() {
  sim::BeadStretch stretch;
  for (int i = 0; i < 3; ++i)
    stretch.push_back({Vec3(2.5e-3 * i, 0, 0), Vec3::UnitZ(), (0.4 + 0.01 * i) * 1e-3, 0.2e-3, 1. + i, 1});
  sim::SweptShell shells;
  sim::append_whole(stretch, 16, shells);
  return bead_surface(std::move(shells));
}

TEST(BeadSurface, HasANormalForEachVertexThatPointsOutOfTheBead) {
  const renderer::SmoothSurface surface = drawn_bead();
  ASSERT_EQ(surface.normals.size(), surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Vec3& at = surface.vertices[i];
    const Vec3 from_axis = at - Vec3(std::clamp(at.x(), 0., 5e-3), 0, 0);
    EXPECT_NEAR(surface.normals[i].norm(), 1, 1e-9);
    EXPECT_GT(surface.normals[i].dot(from_axis), 0) << at.transpose();
  }
}

// A stadium's flat faces point straight up and down, its sides straight out: they are not smoothed into each
// other.
TEST(BeadSurface, IsFlatOnTopAndRoundAtItsSides) {
  const renderer::SmoothSurface surface = drawn_bead();
  double highest = 0, widest = 0;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (std::abs(surface.vertices[i].x() - 2.5e-3) > 1e-9) continue;
    if (surface.vertices[i].z() > 0.0999e-3) highest = std::max(highest, surface.normals[i].z());
    if (surface.vertices[i].y() > 0.2049e-3) widest = std::max(widest, surface.normals[i].y());
  }
  EXPECT_NEAR(highest, 1, 1e-6);
  EXPECT_NEAR(widest, 1, 1e-3);
}

TEST(BeadSurface, TrianglesWindAsTheirNormalsPoint) {
  const renderer::SmoothSurface surface = drawn_bead();
  ASSERT_FALSE(surface.triangles.empty());
  for (const auto& triangle : surface.triangles) {
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(triangle[k]); };
    const Vec3 a = surface.vertices[at(0)], b = surface.vertices[at(1)], c = surface.vertices[at(2)];
    const Vec3 face = (b - a).cross(c - a);
    if (face.norm() < 1e-16) continue;
    EXPECT_GT(face.dot(surface.normals[at(0)] + surface.normals[at(1)] + surface.normals[at(2)]), 0);
  }
}

}  // namespace
}  // namespace understudy::report
