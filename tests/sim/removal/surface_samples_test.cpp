#include "sim/removal/surface_samples.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

TEST(SurfaceSamples, CoverABoxButForItsFoot) {
  const auto t = geometry::box(Vec3(0, 0, 0), Vec3(0.02, 0.03, 0.01));
  const geometry::Mesh part(t.vertices, t.triangles);
  double spacing = 1e-3, area = 0;
  for (const SurfaceSample& s : sample_surface(part, spacing)) {
    area += s.area;
    EXPECT_NEAR(part.signed_distance(s.position), 0, 1e-15);
    EXPECT_NEAR(part.signed_distance(s.position + 1e-3 * s.normal), 1e-3, 1e-9);
    // Strips of a right-angled triangle lie aslant.
    for (const Vec3& corner : s.corners) {
      EXPECT_LE((corner - s.position).norm(), 1.2e-3);
      EXPECT_NEAR(part.signed_distance(corner), 0, 1e-15);
    }
    EXPECT_GT(s.normal.z(), -0.5);
  }
  EXPECT_NEAR(area, 2 * (0.02 + 0.03) * 0.01 + 0.02 * 0.03, 1e-12);
  EXPECT_EQ(spacing, 1e-3);
}

TEST(SurfaceSamples, AreAsFineAsTheMemoryAllowed) {
  const auto t = geometry::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  const geometry::Mesh part(t.vertices, t.triangles);
  double spacing = 1e-3;
  EXPECT_LE(sample_surface(part, spacing).size(), kMostSamples);
  EXPECT_GE(spacing, 3e-3);
  spacing = 0;
  EXPECT_THROW(sample_surface(part, spacing), InputError);
}

}  // namespace
}  // namespace understudy::sim
