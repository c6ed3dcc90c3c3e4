#include "toolpath/support_free/flat_section.h"

#include <gtest/gtest.h>

#include "models/parts/swept_part.h"

namespace understudy::toolpath {
namespace {

TEST(FlatSection, IsThatOfTheLimbAtHand) {
  // A hairpin: at z = 30 mm the plane cuts both legs, 60 mm apart.
  const std::vector<SweptPiece> hairpin{straight_mm(40), arc_mm(30, 180), straight_mm(30)};
  const auto part = swept_part(circle_mm(6), hairpin);
  for (const double x : {0.0, 0.06}) {
    SectionFrame frame;
    frame.origin = {x + 1e-3, 0, 0.03};
    const auto section = section_at(*part, frame);
    ASSERT_TRUE(section);
    EXPECT_EQ(section->contours.size(), 1u);
    EXPECT_NEAR(section->area, std::numbers::pi * 36e-6, 0.1e-6);
    EXPECT_NEAR(section->centroid.x(), -1e-3, 1e-6);
    EXPECT_NEAR(section->radius, 7e-3, 2e-6);
    EXPECT_TRUE(section->holds({0, 0}));
    EXPECT_FALSE(section->holds({x > 0 ? -0.06 : 0.06, 0}));
  }
  SectionFrame beside;
  beside.origin = {0.03, 0, 0.03};
  EXPECT_FALSE(section_at(*part, beside));
}

TEST(FlatSection, AFrameIsCarriedWithoutTurningAboutItsNormal) {
  SectionFrame frame;
  const Vec3 normal = Vec3(0.3, -0.2, 0.9).normalized();
  const SectionFrame carried = frame.carried_to({1, 2, 3}, normal);
  EXPECT_NEAR((carried.normal() - normal).norm(), 0, 1e-12);
  EXPECT_NEAR(carried.u.dot(carried.v), 0, 1e-12);
  const SectionFrame back = carried.carried_to({0, 0, 0}, Vec3::UnitZ());
  EXPECT_NEAR((back.u - Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((carried.out(carried.in({1.1, 2.2, 3})) - carried.origin).dot(normal), 0, 1e-12);
}

}  // namespace
}  // namespace understudy::toolpath
