// Scenarios of the papers with an effect taken out: the expectation that holds the effect must fail, and says
// so.
#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

struct Replacement {
  std::string what, by;  ///< regular expressions of std::regex
};

std::string replaced(std::string text, const std::vector<Replacement>& all) {
  for (const auto& [what, by] : all) {
    EXPECT_TRUE(std::regex_search(text, std::regex(what))) << what;
    text = std::regex_replace(text, std::regex(what), by);
  }
  return text;
}

class WithoutEffect : public testing::Test {
 protected:
  /// A copy of the shipped machine with replacements; its path.
  std::string machine(const std::string& name, const std::vector<Replacement>& all) {
    return folder_.write(name + "-without.yaml",
                         replaced(read_file(kSource + "/models/" + name + "/machine.yaml"), all));
  }
  /// The shipped scenario with replacements, its files where they are.
  std::string run(const std::string& name, const std::vector<Replacement>& all) {
    std::string text = read_file(kSource + "/scenarios/" + name + ".yaml");
    // Words of files beside the scenario.
    text = std::regex_replace(text, std::regex("program: "), "program: " + kSource + "/scenarios/");
    text = std::regex_replace(text, std::regex(" letters/"), " " + kSource + "/scenarios/letters/");
    const std::string file = folder_.write(name + ".yaml", replaced(text, all));
    const Outcome outcome = understudy("scenario run " + file);
    EXPECT_EQ(outcome.status, 1) << name << "\n" << outcome.out << outcome.err;
    return outcome.out;
  }
  /// What the line about this metric begins with.
  static testing::Matcher<std::string> fails(const std::string& metric) {
    return testing::ContainsRegex("FAIL [^\n]*" + metric);
  }

  const Folder folder_;
};

class ExtendedWithoutEffect : public WithoutEffect {};

TEST_F(ExtendedWithoutEffect, NoBacklashNoGouges) {
  const std::string still =
      machine("finishing", {{"play_um: [0-9]+", "play_um: 0"}, {"play_arcmin: [0-9]+", "play_arcmin: 0"}});
  EXPECT_THAT(run("yu-ellipse-1", {{"machine: finishing", "machine: " + still}}), fails("removal.gouge_um"));
}

TEST_F(WithoutEffect, NoWeightNoSag) {
  const std::string light =
      folder_.write("light.yaml", replaced(read_file(kSource + "/models/materials/abs.yaml"),
                                           {{"density_kg_per_m3: 1040", "density_kg_per_m3: 100"}}));
  EXPECT_THAT(run("song-spiral", {{"machine: hexapod", "machine: hexapod\nmaterial: " + light}}),
              fails("sag.max_um"));
}

TEST_F(ExtendedWithoutEffect, NoGapControlNoGapInTheBand) {
  EXPECT_THAT(run("song-gap", {{"gap_control: start", "gap_control: \"off\""}}), fails("gap.start_mm"));
}

TEST_F(WithoutEffect, AWrongNormalRunsIntoThePlane) {
  EXPECT_THAT(run("song-usc-letters", {{"plan: surface slanted_box", "plan: surface slanted_box --upright"}}),
              fails("findings.collision.count"));
}

TEST_F(ExtendedWithoutEffect, NoInflationNothingToTakeOff) {
  EXPECT_THAT(run("yu-ellipse-1", {{"depth_of_cut_mm: 0.7", "depth_of_cut_mm: 0.01"}}),
              fails("removal.volume_mm3"));
}

TEST_F(WithoutEffect, TooLittleLightHoldsNothing) {
  // 0.5 mW at 2 mm/s: Dp ln(E / Ec) = 0.185 mm, where the layers are 0.21 to 0.25 mm high.
  const std::string dim = machine("hexapod", {{"light_power_mw: 5", "light_power_mw: 0.5"}});
  // Planned for the light that the file promises, cured by less.
  const std::string program = folder_ / "fin.gcode";
  ASSERT_EQ(
      understudy("plan surface bottle --tilt -20 20 --layers 8 --feed 2 --machine hexapod+light-guide -o " +
                 program)
          .status,
      0);
  EXPECT_THAT(
      run("song-cnc-accumulation", {{"machine: hexapod\\+light-guide", "machine: " + dim + "+light-guide"},
                                    {"plan: [^\n]*", "program: " + program}}),
      fails("findings.adhesion.count"));
}

}  // namespace
}  // namespace understudy::cli_test
