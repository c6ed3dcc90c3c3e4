#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;
const std::string kBuilt = " --as-built manufactured --seed 5";

/// A calibrated hexapod of the seed above, and a line to print.
struct Lab {
  Lab() {
    program = folder.write(
        "line.gcode",
        "G21\nG90\nM82\nM104 S210 ; warm\nG0 X-20 Y0 Z50\nG1 X20 Y5 Z50 E1.6 F1200 ; the line\nG1 Y15 E2\n");
    calibrated = folder / "calibrated.yaml";
    understudy("sample-poses --machine hexapod --count 24" + kBuilt + " -o " + (folder / "poses.csv"));
    understudy("calibrate " + (folder / "poses.csv") + " --machine hexapod -o " + calibrated);
  }
  double tip_error(const std::string& program_of, const std::string& machine) const {
    const std::string out = folder / "rehearsed";
    std::filesystem::remove_all(out);
    understudy("rehearse " + program_of + " --machine " + machine + kBuilt +
               " --engine quasistatic --gap-control off --no-pictures --out " + out);
    return nlohmann::json::parse(read_file(out + "/summary.json")).at("accuracy").at("tip_rms_um");
  }
  Folder folder;
  std::string program, calibrated;
};

TEST(CompensateCommand, ANominalControllerPrintsWhereTheCalibratedOneDoes) {
  const Lab lab;
  const std::string out = lab.folder / "compensated.gcode";
  const Outcome outcome = understudy("compensate " + lab.program + " --machine " + lab.calibrated +
                                     " --nominal hexapod -o " + out);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 lines go elsewhere"));
  const std::string text = read_file(out);
  EXPECT_THAT(text, HasSubstr("M104 S210 ; warm\n"));
  EXPECT_THAT(text, HasSubstr(" F1200 ; the line\n"));
  // The rehearsal counts from the original's path.
  const double drawn = lab.tip_error(lab.program, "hexapod"),
               calibrated = lab.tip_error(lab.program, lab.calibrated);
  const double compensated = lab.tip_error(out, "hexapod");
  EXPECT_LT(compensated, 1.3 * calibrated);
  EXPECT_GT(drawn, 3 * compensated) << "what manufacture leaves";
}

TEST(CompensateCommand, WithoutNominalTheFilesOwnDrawingCounts) {
  const Lab lab;
  const std::string a = lab.folder / "a.gcode", b = lab.folder / "b.gcode";
  ASSERT_EQ(
      understudy("compensate " + lab.program + " --machine " + lab.calibrated + " --nominal hexapod -o " + a)
          .status,
      0);
  ASSERT_EQ(understudy("compensate " + lab.program + " --machine " + lab.calibrated + " -o " + b).status, 0);
  EXPECT_EQ(read_file(a), read_file(b));
}

TEST(CompensateCommand, TheBenchmarkTellsWhatItMeasures) {
  const Folder folder;
  const Outcome outcome = understudy("benchmark compensation --machine hexapod --machines 1 --seed 3 --out " +
                                     (folder / "study"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("compensated / calibrated"));
  const auto json = nlohmann::json::parse(read_file(folder / "study/compensation.json"));
  const auto& machine = json.at("machines").at(0);
  EXPECT_NEAR(json.at("ratio").get<double>(),
              machine.at("compensated_um").get<double>() / machine.at("calibrated_um").get<double>(), 1e-3);
}

TEST(CompensateCommand, MistakesAreOneLineAndWriteNothing) {
  const Folder folder;
  const std::string program = folder.write("line.gcode", "G1 X1 F600\n"), out = folder / "out.gcode";
  const std::string robot = folder.write("line.src", "DEF line()\nEND\n");
  for (const auto& [words, said] :
       {std::pair{program + " --machine hexapod", "has no calibration"},
        std::pair{program + " --machine hexapod --nominal arm", "its mechanism is arm"},
        std::pair{program + " --machine hexapod --nominal hexapod", "the same file"},
        std::pair{folder / "none.gcode" + std::string(" --machine hexapod --nominal hexapod"),
                  "the same file"}}) {
    const Outcome outcome = understudy("compensate " + words + " -o " + out);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(said));
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

}  // namespace
}  // namespace understudy::cli_test
