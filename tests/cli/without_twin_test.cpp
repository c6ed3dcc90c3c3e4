// The command as a real machine's controller has it: what it does, and what it says it leaves out.
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(WithoutTwin, SaysWhatItLeavesOut) {
  EXPECT_THAT(
      understudy("--help").out,
      AllOf(HasSubstr(
                "without the twin: it leaves out rehearse, inspect, pose, place, verify, register, scenario"),
            HasSubstr("calibrate")));
  const Outcome doctor = understudy("doctor");
  EXPECT_EQ(doctor.status, 0) << doctor.err;
  EXPECT_THAT(doctor.out, AllOf(HasSubstr("left out of this build"), HasSubstr("benchmark")));
  for (const char* word : {"rehearse x.gcode", "inspect x.gcode", "pose X0", "place x.gcode", "verify x",
                           "register", "benchmark calibration", "sample-poses -o x.csv", "render scene"}) {
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

/// A level chessboard of 7 x 4 inner corners as PGM.
std::string board_picture() {
  std::string levels;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x) {
      const bool on_board = x >= 30 && x < 350 && y >= 40 && y < 240;
      levels += static_cast<char>(on_board && ((x - 30) / 40 + (y - 40) / 40) % 2 == 0 ? 40 : 200);
    }
  return "P5 400 300 255\n" + levels;
}

TEST(WithoutTwin, MeasuresPicturesOfBoards) {
  const Folder folder;
  std::string rig = read_file(kSource + "/examples/rig.yaml");
  for (const auto& [from, to] : {std::pair("width_px: 1600", "width_px: 400"),
                                 {"height_px: 1200", "height_px: 300"},
                                 {"columns: 12", "columns: 7"},
                                 {"rows: 9", "rows: 4"}})
    for (std::size_t at = rig.find(from); at != std::string::npos; at = rig.find(from, at + 1))
      rig.replace(at, std::string(from).size(), to);
  folder.write("rig.yaml", rig);
  folder.write("camera0-layer05.png", board_picture());
  const Outcome outcome =
      understudy("measure board " + (folder / "camera0-layer05.png") + " --rig " + (folder / "rig.yaml"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const std::string last =
      "camera0-layer05.png,0,5,6,3,";  // the last corner, 6 and 3 squares on from 69.5, 79.5
  const std::size_t at = outcome.out.find(last);
  ASSERT_NE(at, std::string::npos) << outcome.out;
  EXPECT_NEAR(std::stod(outcome.out.substr(at + last.size())), 309.5, 0.03);
  EXPECT_THAT(outcome.err, HasSubstr("camera 0: 1 of 1 boards"));
}

}  // namespace
}  // namespace understudy::cli_test
