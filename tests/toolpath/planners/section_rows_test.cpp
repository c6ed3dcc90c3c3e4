#include "toolpath/planners/section_rows.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/told_progress.h"
#include "toolpath/planners/surface_planner.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

TEST(SectionRows, RunToAndFroAPitchApartAndLayersGrowAlongTheNormal) {
  const auto crown = geometry::read_stl(UNDERSTUDY_SOURCE_DIR "/models/parts/crown_core.stl");
  SectionRows rows;
  rows.count = 4;
  rows.pitch = 0.45e-3;
  rows.tilt_min = -15 * kDegree;
  rows.tilt_max = 15 * kDegree;
  const auto curves = section_rows(*crown, rows);
  ASSERT_EQ(curves.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(curves[i].front().y(), (static_cast<double>(i) - 1.5) * 0.45e-3, 1e-9);
    EXPECT_EQ(curves[i].front().x() < 0, i % 2 == 0);
  }
  SurfacePlan p;
  p.gap = p.bead_height = 0.13e-3;
  p.standoff = 2e-3;
  p.clearance = 5e-3;
  p.step = 1e-3;
  p.chord_tolerance = 3e-6;
  p.feed = 5e-3;
  p.approach_feed = 1e-3;
  p.bead_width = 0.48e-3;
  p.filament_diameter = 1.75e-3;
  p.tilt_max = 30 * kDegree;
  const Program program = plan_surface(*crown, curves, 3, p);
  std::vector<double> heights;
  for (const Step& s : program.steps) {
    if (s.kind != StepKind::print) continue;
    // The core's crown is a cylinder of 40 mm about y through z = 20.41 - 40.39 mm.
    const double height = std::hypot(s.X_WT.translation().x(), s.X_WT.translation().z() + 19.98e-3) - 40e-3;
    heights.push_back(height);
  }
  ASSERT_EQ(heights.size() % 12, 0u);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto layer = static_cast<double>(i / (heights.size() / 3));
    EXPECT_NEAR(heights[i], (layer + 1) * 0.13e-3, 1e-6);  // 0.3 um of it is the sag of facets
  }
  rows.count = 200;
  try {
    section_rows(*crown, rows);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("row 1 of 200"));
  }
}

TEST(SectionRows, TellEachRowAndEachCurve) {
  const auto crown = geometry::read_stl(UNDERSTUDY_SOURCE_DIR "/models/parts/crown_core.stl");
  understudy::test::ToldProgress rows_told, curves_told;
  SectionRows rows;
  rows.count = 4;
  rows.pitch = 0.45e-3;
  rows.tilt_min = -15 * kDegree;
  rows.tilt_max = 15 * kDegree;
  rows.progress = rows_told.teller();
  const auto curves = section_rows(*crown, rows);
  rows_told.expect_even(0.2501);
  SurfacePlan p;
  p.gap = p.bead_height = 0.13e-3;
  p.standoff = 2e-3;
  p.clearance = 5e-3;
  p.step = 1e-3;
  p.chord_tolerance = 3e-6;
  p.feed = 5e-3;
  p.approach_feed = 1e-3;
  p.bead_width = 0.48e-3;
  p.filament_diameter = 1.75e-3;
  p.tilt_max = 30 * kDegree;
  p.progress = curves_told.teller();
  plan_surface(*crown, curves, 1, p);
  EXPECT_EQ(curves_told.times(), 4u);
  curves_told.expect_even(0.2501);
}

}  // namespace
}  // namespace understudy::toolpath
