#include "machine/file/control_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "machine/description.h"

namespace understudy::machine {
namespace {

using ::testing::HasSubstr;

ControlSettings control_of(const std::string& changes) { return load_machine("hexapod" + changes).control; }

std::string error_of(const std::string& changes) {
  try {
    control_of(changes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ControlSection, LeavesDefaultsWhereTheFileSaysNothing) {
  const ControlSettings said = control_of(""), defaults;
  EXPECT_EQ(said.planner.lookahead, defaults.planner.lookahead);
  EXPECT_EQ(said.gap.approach.step_fraction, defaults.gap.approach.step_fraction);
  EXPECT_EQ(said.gap.following.settle_time, defaults.gap.following.settle_time);
  EXPECT_EQ(said.gap.line.slope_walk, defaults.gap.line.slope_walk);
}

TEST(ControlSection, TakesValuesInTheirUnits) {
  const ControlSettings control = control_of(
      "{planner.lookahead_mm: 50, planner.corner_share: 0.25, planner.lead_time_ms: 80, planner.gap_reserve: "
      "0.1, "
      "gap_control.approach.tolerance_um: 12, gap_control.approach.frames_averaged: 5, "
      "gap_control.following.rate_max_mm_per_s: 0.25, gap_control.following.blind_s: 0.75, "
      "gap_control.following.drift_um: 3}");
  EXPECT_DOUBLE_EQ(control.planner.lookahead, 0.05);
  EXPECT_DOUBLE_EQ(control.planner.corner_share, 0.25);
  EXPECT_DOUBLE_EQ(control.planner.lead_time, 0.08);
  EXPECT_DOUBLE_EQ(control.planner.gap_reserve, 0.1);
  EXPECT_DOUBLE_EQ(control.gap.approach.tolerance, 12e-6);
  EXPECT_EQ(control.gap.approach.frames_averaged, 5);
  EXPECT_DOUBLE_EQ(control.gap.following.rate_max, 0.25e-3);
  EXPECT_DOUBLE_EQ(control.gap.following.blind_time, 0.75);
  EXPECT_DOUBLE_EQ(control.gap.line.drift, 3e-6);
}

TEST(ControlSection, RefusesWhatNoControllerCanDo) {
  EXPECT_THAT(error_of("{gap_control.approach.step_fraction: 1.2}"),
              HasSubstr("gap_control.approach.step_fraction is 1.2, outside 0.01 to 0.95"));
  EXPECT_THAT(error_of("{gap_control.approach.step_fracton: 0.5}"),
              HasSubstr("did you mean 'step_fraction'?"));
  EXPECT_THAT(error_of("{planner.lookahead_mm: 0}"),
              HasSubstr("planner.lookahead_mm is 0 mm, outside 1 to 10000 mm"));
}

}  // namespace
}  // namespace understudy::machine
