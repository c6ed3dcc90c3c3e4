#include "control/registration/probing_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"

namespace understudy::control {
namespace {

using ::testing::HasSubstr;

constexpr double kMargin = 1e-3;

geometry::Mesh mesh_of(const geometry::Triangles& t) { return {t.vertices, t.triangles}; }

const std::pair<Vec3, Vec3> kSlab{{-20e-3, -20e-3, 0}, {20e-3, 20e-3, 20e-3}};
const ProbingPlace kMiddle{{0, 0, 20e-3}, Vec3::UnitZ(), 0};

TEST(ProbingPlace, TheWayLeadsFromAboveStraightDownTheToolsAxis) {
  const auto part = mesh_of(geometry::boxes({kSlab}));
  const ProbingCheck check(hexapod(), part, kMargin);
  EXPECT_EQ(check.why_not(kMiddle), "");
  const ProbingWay way = check.way_to(kMiddle);
  EXPECT_GE(way.start.translation().z(), 20e-3 + kMargin + 1e-3 - 1e-12)
      << "no touch where the part stands highest";
  EXPECT_GT(way.near.translation().z(), way.start.translation().z());
  EXPECT_GE(way.above.translation().z(), 30e-3);
  EXPECT_EQ(way.above.translation().head<2>(), way.near.translation().head<2>());
}

TEST(ProbingPlace, SaysWhyAPlaceCannotBeMeasured) {
  // A wall of 20 mm on the slab, away from laser and camera: the heater block, 8 mm to each side of the axis,
  // is 12 mm over the tip.
  const auto part = mesh_of(geometry::boxes({kSlab, {{-12e-3, -20e-3, 20e-3}, {-6e-3, 20e-3, 40e-3}}}));
  const ProbingCheck check(hexapod(), part, kMargin);
  EXPECT_THAT(check.why_not(kMiddle), HasSubstr("nearer than"));
  EXPECT_EQ(check.why_not({{14e-3, 0, 20e-3}, Vec3::UnitZ(), 0}), "");
  EXPECT_THAT(check.why_not({{19.5e-3, 0, 20e-3}, Vec3::UnitZ(), 0}), HasSubstr("ends"));
  EXPECT_THAT(check.why_not({{20e-3, 0, 10e-3}, Vec3::UnitX(), 0}), HasSubstr("out of reach"));
}

// The beam comes down at 40 degrees, its dot 1.1 mm from the axis: a post of 4 mm at 4.5 mm hides it.
TEST(ProbingPlace, APartThatHidesItsOwnDotIsSeenThrough) {
  const auto clear = mesh_of(geometry::boxes({kSlab}));
  const auto post = mesh_of(geometry::boxes({kSlab, {{-6e-3, 4.5e-3, 19e-3}, {6e-3, 6e-3, 25.5e-3}}}));
  EXPECT_EQ(ProbingCheck(hexapod(), clear, 0).why_not(kMiddle), "");
  EXPECT_THAT(ProbingCheck(hexapod(), post, 0).why_not(kMiddle), HasSubstr("hides the dot"));
}

TEST(ProbingPlace, APartThatMayStandAnywhereIsRefused) {
  const auto part = mesh_of(geometry::boxes({kSlab}));
  EXPECT_THROW(ProbingCheck(hexapod(), part, 5e-3), InputError);
}

}  // namespace
}  // namespace understudy::control
