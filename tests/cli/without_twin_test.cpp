// The command as a real machine's controller has it: what it does, and what it says it leaves out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/output_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kSource = UNDERSTUDY_SOURCE_DIR;

TEST(WithoutTwin, SaysWhatItLeavesOut) {
  EXPECT_THAT(understudy("--help").out,
              AllOf(HasSubstr("without the twin: it leaves out rehearse, scenario"), HasSubstr("calibrate")));
  const Outcome doctor = understudy("doctor");
  EXPECT_EQ(doctor.status, 0) << doctor.err;
  EXPECT_THAT(doctor.out, AllOf(HasSubstr("left out of this build"), HasSubstr("benchmark")));
  for (const char* word :
       {"rehearse x.gcode", "benchmark calibration", "sample-poses -o x.csv", "render scene"}) {
    const Outcome refused = understudy(word);
    EXPECT_EQ(refused.status, 2) << word;
    EXPECT_THAT(refused.err, HasSubstr("this build is without the twin: ")) << word;
  }
}

TEST(WithoutTwin, CalibratesPlansAndListsMachines) {
  const Folder folder;
  const Outcome calibrated =
      understudy("calibrate " + kSource + "/scenarios/calibration/hexapod-24-poses.csv -o " +
                 (folder / "m.yaml") + " --report " + (folder / "report"));
  EXPECT_EQ(calibrated.status, 0) << calibrated.err;
  EXPECT_THAT(read_file(folder / "report/report.html"), HasSubstr("<svg"));
  EXPECT_EQ(understudy("machines").status, 0);
  EXPECT_EQ(understudy("export urdf --machine arm -o " + (folder / "arm.urdf")).status, 0);
  const Outcome plan = understudy("plan spiral -o " + (folder / "spiral.gcode"));
  EXPECT_EQ(plan.status, 0) << plan.err;
}

}  // namespace
}  // namespace understudy::cli_test
