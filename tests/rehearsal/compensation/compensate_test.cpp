#include "rehearsal/compensation/compensate.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using machine::MachineDescription;
using ::testing::HasSubstr;

const std::string kProgram =
    "; a corner\nM104 S210\nG1 X-10 Y0 Z50 F1200\nG1 X10 E1 ; along\nM106 S128 (fan)\nG1 Y12 E1.6\nM30\n";

MachineDescription calibrated_hexapod() {
  MachineDescription known = machine::load_machine("hexapod");
  for (std::size_t i = 0; i < 3; ++i) known.hexapod().geometry.length_offset[i] += 0.8e-3;
  known.calibration = {"by hand", "", "", 0, 0};
  return known;
}

Compensation of(const MachineDescription& known, const CompensationRequest& request = {},
                const std::string& text = kProgram) {
  const machine::CalibratedParameters nothing;
  return compensate({machine::load_machine("hexapod"), known, nothing, text, "p.gcode"}, request);
}

TEST(Compensate, LeavesPredictedErrorsOfTheToleranceAlone) {
  MachineDescription known = calibrated_hexapod();
  known.hexapod().play = {};
  const Compensation done = of(known);
  EXPECT_GT(done.predicted_before, 0.3e-3) << "three struts are 0.8 mm off";
  EXPECT_LT(done.predicted_geometry, 2e-6) << "the tolerance of the path";
  EXPECT_EQ(done.rounds, 0) << "there is no play to correct";
}

TEST(Compensate, TakesThePredictedPlayOff) {
  const Compensation done = of(calibrated_hexapod());
  // Half the play of nut and ball, 37.5 um a strut, moves the tip by some 40 um.
  EXPECT_GT(done.predicted_geometry, 20e-6);
  EXPECT_LT(done.predicted, 0.3 * done.predicted_geometry);
  EXPECT_GT(done.rounds, 0);
}

TEST(Compensate, KeepsCommentsLinesAndOtherWords) {
  const Compensation done = of(calibrated_hexapod());
  for (const char* kept :
       {"; a corner\nM104 S210\nG1 X", " F1200\n", " ; along\n", "M106 S128 (fan)\n", "M30\n"})
    EXPECT_THAT(done.text, HasSubstr(kept));
  EXPECT_EQ(std::count(done.text.begin(), done.text.end(), '\n'), 7 + done.added_lines);
  double filament = 0;
  for (const toolpath::Step& step : done.program.steps) filament += step.filament;
  EXPECT_NEAR(filament, 1.6e-3, 1e-9);
}

TEST(Compensate, CountedFromRestASideThatNeverChangesIsNone) {
  CompensationRequest request;
  request.reference = PlayReference::rest;
  // The platform hangs in its struts: along this program each play stays on the side that it has at home.
  EXPECT_LT(of(calibrated_hexapod(), request).predicted_geometry, 5e-6);
}

TEST(Compensate, ALimitIsToldByLineValueAndLimit) {
  try {
    static_cast<void>(of(calibrated_hexapod(), {}, "M104 S210\nG1 X0 F1200\nG1 Z150 E1\n"));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().line, 3);
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:3: on the calibrated machine: "));
    EXPECT_THAT(error.what(), HasSubstr("strut"));
  }
}

TEST(Compensate, AnotherMachineIsRefused) {
  CompensationRequest request;
  request.program = std::string(UNDERSTUDY_SOURCE_DIR) + "/scenarios/song-bottle.gcode";
  request.machine = "hexapod";
  try {
    static_cast<void>(compensate(request));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no calibration"));
  }
  request.nominal = "arm";
  EXPECT_THROW(static_cast<void>(compensate(request)), InputError);
}

}  // namespace
}  // namespace understudy::rehearsal
