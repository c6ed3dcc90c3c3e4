// `rehearse --replay` and `identify`: records of twins whose truth is a file, replayed on others and asked
// for that truth.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kMoves = std::string(UNDERSTUDY_SOURCE_DIR) + "/scenarios/identify/hexapod.gcode";
const std::string kWithEncoders = " --machine 'hexapod{load_encoders.count_um: 1}'";

// [mm], [um], [permille]; the drawing has 170, 50 + 25 and 0.
constexpr std::array kOffset{170.213, 169.871, 170.055, 169.702, 170.318, 170.004};
constexpr std::array kNut{61.0, 44.0, 52.0, 38.0, 57.0, 49.0};
constexpr std::array kBall{25.0, 29.0, 21.0, 24.0, 27.0, 19.0};
constexpr std::array kLead{0.21, -0.17, 0.05, 0.31, -0.28, 0.11};
constexpr std::array kPeriodic{4.0, 6.0, 3.0, 5.0, 2.0, 7.0};

std::string truth() {
  std::string text = "machine: hexapod\nstruts:\n", drives = "drives:\n";
  for (std::size_t i = 0; i < kOffset.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    text += "  - {strut: " + number + ", length_offset_mm: " + std::to_string(kOffset[i]) +
            ", nut_play_um: " + std::to_string(kNut[i]) + ", ball_play_um: " + std::to_string(kBall[i]) +
            "}\n";
    drives += "  - {drive: " + number + ", lead_permille: " + std::to_string(kLead[i]) +
              ", periodic_um: " + std::to_string(kPeriodic[i]) + ", phase_deg: 40}\n";
  }
  return text + drives;
}

std::string recording(const std::string& machine, const std::string& as_built, const std::string& program,
                      const Folder& folder, const std::string& record) {
  return "rehearse " + program + machine + " --as-built " + as_built +
         " --engine quasistatic --gap-control off --no-pictures --tip-tolerance 5 --record " +
         (folder / record) + " --out " + (folder / (record + ".out"));
}

/// One record of three minutes for all tests, of a machine with encoders behind the play.
class Identify : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    built_ = folder_->write("truth.yaml", truth());
    recorded_ = understudy(recording(kWithEncoders, built_, kMoves, *folder_, "a.record"));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(recorded_.status, 0) << recorded_.err << recorded_.out; }
  static std::string record() { return *folder_ / "a.record"; }
  static std::string shortened(const std::string& name, double share) {
    const std::string bytes = read_file(record());
    return folder_->write(
        name, bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
  }

  Folder own_;
  static inline Folder* folder_ = nullptr;
  static inline std::string built_;
  static inline Outcome recorded_;
};

TEST_F(Identify, FindsThePlayZerosAndLeadsThatTheMachineWasBuiltWith) {
  const Outcome found = understudy("identify " + record() + kWithEncoders + " -o " + (own_ / "found.yaml") +
                                   " --summary " + (own_ / "found.json"));
  ASSERT_EQ(found.status, 0) << found.err;
  const auto json = nlohmann::json::parse(read_file(own_ / "found.json"));
  ASSERT_EQ(json["axes"].size(), kOffset.size());
  for (std::size_t i = 0; i < kOffset.size(); ++i) {
    const auto& axis = json["axes"][i];
    const double play = kNut[i] + kBall[i];
    EXPECT_NEAR(axis["play_um"].get<double>(), play, 0.1 * play) << i;
    EXPECT_NEAR(axis["zero_um"].get<double>(), 1e3 * (kOffset[i] - 170), 10) << i;
    EXPECT_NEAR(axis["lead_permille"].get<double>(), kLead[i], 0.05) << i;
    EXPECT_NEAR(axis["periodic_um"].get<double>(), kPeriodic[i], 0.5) << i;
  }
  // The machine file is one, and the twin of `calibrated` is drawn by it.
  const std::string file = read_file(own_ / "found.yaml");
  EXPECT_THAT(file, HasSubstr("lead_permille: [0.2"));
  EXPECT_EQ(understudy("schema machine --check " + (own_ / "found.yaml")).status, 0);
  const std::string program = own_.write("short.gcode", "G21\nG90\nG1 X1 Y0 Z50 F600\n");
  const Outcome twin = understudy("rehearse " + program + " --machine " + (own_ / "found.yaml") +
                                  " --as-built calibrated --engine quasistatic --gap-control off "
                                  "--no-pictures --out " +
                                  (own_ / "out"));
  EXPECT_EQ(twin.status, 0) << twin.err << twin.out;
}

TEST_F(Identify, ATwinByWhatWasFoundFollowsTheRecordAndTheDrawingDoesNot) {
  ASSERT_EQ(understudy("identify " + record() + kWithEncoders + " -o " + (own_ / "found.yaml") +
                       " --as-built-out " + (own_ / "built.yaml"))
                .status,
            0);
  const std::string replay = "rehearse --replay " + record() + kWithEncoders + " --engine quasistatic ";
  const Outcome drawn = understudy(replay + "--as-built nominal --out " + (own_ / "drawn"));
  EXPECT_EQ(drawn.status, 1) << drawn.err;
  EXPECT_THAT(drawn.out, HasSubstr("the twin does not agree: l"));
  const auto json = nlohmann::json::parse(read_file(own_ / "drawn/replay.json"));
  EXPECT_EQ(json["agrees"], false);
  for (std::size_t i = 0; i < kOffset.size(); ++i) {
    // Drives read the same whatever hangs on them; behind the play the zeros show.
    EXPECT_LT(std::abs(json["axes"][i]["largest_um"].get<double>()), 1) << i;
    const auto& load = json["axes"][kOffset.size() + i];
    EXPECT_EQ(load["side"], "load");
    EXPECT_NEAR(load["mean_um"].get<double>(), 1e3 * (kOffset[i] - 170), 60) << i;
  }
  const Outcome found =
      understudy(replay + "--as-built " + (own_ / "built.yaml") + " --out " + (own_ / "found"));
  EXPECT_EQ(found.status, 0) << found.out << found.err;
  EXPECT_THAT(found.out, HasSubstr("the twin agrees with the machine"));
  const auto compared = nlohmann::json::parse(read_file(own_ / "found/replay.json"));
  for (const auto& axis : compared["axes"]) EXPECT_LT(axis["rms_um"].get<double>(), 10) << axis;
  const Outcome strict = understudy(replay + "--agree-within 0.001 --as-built " + (own_ / "built.yaml") +
                                    " --out " + (own_ / "strict"));
  EXPECT_EQ(strict.status, 1);
  EXPECT_THAT(read_file(own_ / "strict/replay.csv"), HasSubstr("side,time_s,line,l1_machine_mm,l1_twin_mm,"));
  EXPECT_THAT(read_file(own_ / "strict/report.html"), HasSubstr("<svg"));
}

TEST_F(Identify, WithoutEncodersBehindThePlayItSaysWhatCannotBeTold) {
  const std::string program = own_.write("line.gcode", "G21\nG90\nG1 X10 Y0 Z50 F300\nG1 X0 Y0 Z50\n");
  ASSERT_EQ(understudy(recording("", built_, program, own_, "plain.record")).status, 0);
  const Outcome found = understudy("identify " + (own_ / "plain.record") + " -o " + (own_ / "found.yaml"));
  EXPECT_EQ(found.status, 1) << found.err;
  EXPECT_THAT(found.out, HasSubstr("l3 play: the record has no encoder behind the play of this axis"));
  EXPECT_FALSE(std::filesystem::exists(own_ / "found.yaml"));
  const Outcome replay = understudy("rehearse --replay " + (own_ / "plain.record") +
                                    " --engine quasistatic --as-built nominal --out " + (own_ / "out"));
  EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("zero offsets and leads of the machine cannot show"));
}

TEST_F(Identify, UsesWhatIsWholeOfARecordThatWasCutShort) {
  const std::string cut = shortened("cut.record", 0.61803);
  const Outcome found = understudy("identify " + cut + kWithEncoders + " -o " + (own_ / "found.yaml"));
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("the record was cut short: used up to its last whole entry"));
}

TEST_F(Identify, RefusesWhatIsNoRecordOfThisMachine) {
  const auto refused = [&](const std::string& file, const std::string& machine, const std::string& why) {
    for (const std::string& command :
         {"identify " + file + machine + " -o " + (own_ / "found.yaml"),
          "rehearse --replay " + file + machine + " --engine quasistatic --out " + (own_ / "out")}) {
      const Outcome outcome = understudy(command);
      EXPECT_EQ(outcome.status, 2) << command << outcome.out;
      EXPECT_THAT(outcome.err, HasSubstr(why)) << command;
      EXPECT_FALSE(std::filesystem::exists(own_ / "found.yaml"));
      EXPECT_FALSE(std::filesystem::exists(own_ / "out"));
    }
  };
  refused(record(), "", "it was recorded with another machine file");
  refused(record(), " --machine five-axis", "it is of a machine of 6 axes");
  refused(own_ / "none.record", kWithEncoders, "cannot be read");
  const std::string later = "understudy.port-record/2" + read_file(record()).substr(24);
  refused(own_.write("later.record", later), kWithEncoders, "it is no record of a port");
  refused(shortened("first.record", 2e-5), kWithEncoders, "cut short before the first state");
  const std::string step = own_.write("step.gcode", "G21\nG90\nG1 X1 Y0 Z50 F600\n");
  ASSERT_EQ(understudy(recording(kWithEncoders, built_, step, own_, "brief.record")).status, 0);
  const Outcome brief =
      understudy("identify " + (own_ / "brief.record") + kWithEncoders + " -o " + (own_ / "found.yaml"));
  EXPECT_EQ(brief.status, 2) << brief.out;
  EXPECT_THAT(brief.err, HasSubstr("at least 1 s of motion are needed"));
  const Outcome other = understudy("rehearse --replay " + record() + kWithEncoders + " --fixture bottle");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("--fixture is of no use with it"));
}

}  // namespace
}  // namespace understudy::cli_test
