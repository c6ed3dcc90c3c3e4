// The commands around calibration, as a user runs them.
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/output_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kSource = UNDERSTUDY_SOURCE_DIR;
const std::string kSample = kSource + "/scenarios/calibration/hexapod-24-poses.csv";

json summary(const Folder& folder, const std::string& name) {
  return json::parse(read_file(folder.path() / name / "summary.json"));
}

TEST(Calibrate, TheSampleGivesAMachineThatOtherCommandsRead) {
  const Folder folder;
  const Outcome outcome =
      understudy("calibrate " + kSample + " -o " + (folder / "m.yaml") + " --report " + (folder / "report"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(folder.entries(), 2);
  EXPECT_THAT(read_file(folder / "report/report.html"), StartsWith("<!doctype html>"));
  const json s = summary(folder, "report");
  EXPECT_EQ(s["schema"], "understudy.calibration/1");
  // docs/reference.md#calibration-figures at 24 poses: 13 um D-optimal with maximum likelihood to 24 um, the
  // worst random bound; RMS.
  EXPECT_GT(s["tip"]["sigma_rms_um"], 8);
  EXPECT_LT(s["tip"]["sigma_rms_um"], 24);
  EXPECT_EQ(s["warnings"], json::array());

  folder.write("poses.csv", "x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,50,1,0,0,0\n");
  const std::string in = " < " + (folder / "poses.csv");
  const Outcome drawn = understudy("axes --machine hexapod" + in);
  const Outcome calibrated = understudy("axes --machine " + (folder / "m.yaml") + in);
  EXPECT_EQ(calibrated.status, 0) << calibrated.err;
  EXPECT_THAT(calibrated.out, HasSubstr(",ok"));
  EXPECT_NE(calibrated.out, drawn.out);
}

TEST(Calibrate, TheSampleIsWhatItsFirstLineSays) {
  const Folder folder;
  ASSERT_EQ(
      understudy("sample-poses --count 24 --as-built manufactured --seed 5 -o " + (folder / "s.csv")).status,
      0);
  const auto rows = [](const std::string& text) { return text.substr(text.find('\n')); };
  EXPECT_EQ(rows(read_file(folder / "s.csv")), rows(read_file(kSample)));
}

TEST(Calibrate, AnArmHasTheRobustEstimatorToo) {
  const Folder folder;
  const std::string poses = folder / "poses.csv",
                    called = "calibrate " + poses + " --machine arm --estimator ";
  ASSERT_EQ(understudy("sample-poses --machine arm --count 12 --as-built manufactured -o " + poses).status,
            0);
  const Outcome outcome = understudy(called + "robust -o " + (folder / "m.yaml"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("30 parameters by robust"));
  EXPECT_TRUE(fs::exists(folder.path() / "m.yaml"));
  const Outcome refused = understudy(called + "whitened -o " + (folder / "w.yaml"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("an open chain has maximum_likelihood and robust"));
  EXPECT_FALSE(fs::exists(folder.path() / "w.yaml"));
}

TEST(Calibrate, RefusesInOneLineAndWritesNothing) {
  const Folder folder;
  const std::string out = " -o " + (folder / "m.yaml") + " --report " + (folder / "report");
  const std::vector<std::pair<std::string, std::string>> calls{
      {"calibrate absent.csv" + out, "absent.csv"},
      {"calibrate " + kSample + out + " --estimator maximum_likelihod", "maximum_likelihood"},
      {"calibrate " + kSample + out + " --estimator with_play", "a1..a6"},
      {"calibrate " + kSample + out + " --machine arm", "l1_mm"},
      {"calibrate " + kSample + out + " --noise 0,1", "--noise 0"},
      {"calibrate " + kSample + " -o " + (folder / "m.txt"), ".yaml"},
      {"sample-poses --count 0 -o " + (folder / "s.csv"), "--count 0"},
      {"sample-poses --design best -o " + (folder / "s.csv"), "--design best"},
      {"sample-poses --from pixels -o " + (folder / "s.csv"), "--as-built"},
  };
  for (const auto& [words, part] : calls) {
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << words;
    EXPECT_EQ(folder.entries(), 0) << words;
  }
}

/// A print on the twin as manufactured, and what its summary says.
json rehearsed(const Folder& folder, const std::string& options, const std::string& name) {
  const Outcome outcome =
      understudy("rehearse " + kSource +
                 "/scenarios/song-bottle.gcode --fixture bottle --engine quasistatic --as-built "
                 "manufactured --seed 5 --no-pictures " +
                 options + " --out " + (folder / name));
  EXPECT_LE(outcome.status, 1) << outcome.err;
  return summary(folder, name);
}

TEST(BeforeCalibration, ItsFiguresAreThoseOfARunOfItsOwn) {
  const Folder folder;
  ASSERT_EQ(understudy("calibrate " + kSample + " -o " + (folder / "m.yaml")).status, 0);
  const json old_one = rehearsed(folder, "--gap-control off", "old");
  const json new_one = rehearsed(folder, "--gap-control off --machine " + (folder / "m.yaml"), "new");
  const json both = rehearsed(folder, "--machine " + (folder / "m.yaml") + " --before hexapod", "both");
  const json& c = both["calibration"];
  EXPECT_EQ(c["machine_before"], "hexapod");
  EXPECT_EQ(c["machine_after"], "m.yaml");
  for (const char* figure : {"tip_rms_um", "tip_p95_um", "tip_max_um", "orientation_max_mrad"}) {
    const std::string name = figure, stem = name.substr(0, name.rfind('_')),
                      unit = name.substr(name.rfind('_'));
    EXPECT_EQ(c[stem + "_before" + unit], old_one["accuracy"][figure]) << figure;
    EXPECT_EQ(c[stem + "_after" + unit], new_one["accuracy"][figure]) << figure;
  }
  EXPECT_EQ(both["provenance"]["machine_before_sha256"], old_one["provenance"]["machine_sha256"]);
  EXPECT_FALSE(new_one.contains("calibration"));
  EXPECT_THAT(read_file(folder / "both/report.html"), HasSubstr("\"trace_before_calibration\":{"));
}

TEST(BeforeCalibration, AnotherMachineIsRefusedInOneLine) {
  const Folder folder;
  ASSERT_EQ(understudy("calibrate " + kSample + " -o " + (folder / "m.yaml")).status, 0);
  std::string other = read_file(kSource + "/models/hexapod/machine.yaml");
  const std::string name = "name: hexapod", deviation = "deviation_mm: 15";
  ASSERT_NE(other.find(deviation), std::string::npos);
  const std::string redrawn =
      folder.write("redrawn.yaml",
                   std::string(other).replace(other.find(deviation), deviation.size(), "deviation_mm: 14"));
  const std::string renamed =
      folder.write("renamed.yaml", other.replace(other.find(name), name.size(), "name: heptapod"));
  const std::vector<std::pair<std::string, std::string>> calls{{"arm", "mechanism is arm"},
                                                               {"absent.yaml", "absent.yaml"},
                                                               {folder / "m.yaml", "the same file"},
                                                               {redrawn, "drawn differently"},
                                                               {renamed, "another machine"}};
  for (const auto& [before, part] : calls) {
    const Outcome outcome =
        understudy("rehearse " + kSource + "/scenarios/song-bottle.gcode --machine " + (folder / "m.yaml") +
                   " --before " + before + " --out " + (folder / "out"));
    EXPECT_EQ(outcome.status, 2) << before;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << before << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << before;
    EXPECT_FALSE(fs::exists(folder.path() / "out")) << before;
  }
}

class ClosedLoop : public ::testing::TestWithParam<std::string> {};

TEST_P(ClosedLoop, ACalibrationOfTheTwinLowersTheTipErrorOfItsRehearsal) {
  const Folder folder;
  ASSERT_EQ(understudy("sample-poses --count 24 --as-built manufactured --seed 5 --from " + GetParam() +
                       " -o " + (folder / "poses.csv"))
                .status,
            0);
  const Outcome outcome = understudy("calibrate " + (folder / "poses.csv") + " -o " + (folder / "m.yaml"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json c =
      rehearsed(folder, "--machine " + (folder / "m.yaml") + " --before hexapod", "out")["calibration"];
  const double before = c["tip_rms_before_um"], after = c["tip_rms_after_um"];
  RecordProperty("before_um", std::to_string(before));
  RecordProperty("after_um", std::to_string(after));
  // As manufactured above 1 mm; calibrated below 0.1 mm, what the play leaves included.
  EXPECT_GT(before, 1000);
  EXPECT_LT(after, 100);
}

INSTANTIATE_TEST_SUITE_P(Calibrate, ClosedLoop, ::testing::Values("noise", "pixels"));

class EveryPicture : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryPicture, ComesWithItsTruthAndTheSameAgain) {
  const Folder folder;
  for (const char* name : {"a", "b"}) {
    const Outcome outcome = understudy("render " + GetParam() + " -o " + (folder / name) + ".png");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(read_file(folder / "a.png"), read_file(folder / "b.png"));
  EXPECT_THAT(read_file(folder / "a.png"), StartsWith("\x89PNG"));
  const json truth = json::parse(read_file(folder / "a.json"));
  EXPECT_EQ(truth["schema"], "understudy.image/1");
  EXPECT_EQ(truth["kind"], GetParam());
}

INSTANTIATE_TEST_SUITE_P(Render, EveryPicture, ::testing::Values("laser", "chessboard", "targets", "scene"));

TEST(Render, RefusesInOneLineAndWritesNothing) {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> calls{
      {"laser --machine five-axis", "laser"},
      {"chessboard --layer 11", "--layer 11"},
      {"targets --camera 2", "--camera 2"},
      {"scene --pose 0,0,50,1,1,0,0", "quaternion"},
      {"scene --pose 900,0,50,1,0,0,0", "cannot take"},
      {"portrait", "portrait"},
  };
  for (const auto& [words, part] : calls) {
    const Outcome outcome = understudy("render " + words + " -o " + (folder / "p.png"));
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << words;
    EXPECT_EQ(folder.entries(), 0) << words;
  }
}

TEST(Calibrate, APlugInStandsInForAnEstimator) {
  const Folder folder;
  const std::string command = "calibrate " + kSample + " -o " + (folder / "m.yaml");
  const Outcome good = understudy(command + " --plugin 'python3 " + kSource +
                                  "/examples/calibration-plugin/strut_by_strut.py'");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("not known"));
  const Outcome bad =
      understudy("calibrate " + kSample + " -o " + (folder / "n.yaml") + " --plugin 'exit 4'");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("plug-in: exit 4: ended with status 4"));
  EXPECT_EQ(folder.entries(), 1) << "nothing is written where there is no machine";
}

}  // namespace
}  // namespace understudy::cli_test
