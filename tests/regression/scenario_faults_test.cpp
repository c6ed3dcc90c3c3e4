#include "regression/scenario_faults.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "regression/scenario_file.h"

namespace understudy::regression {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The faults of a scenario file whose other keys are sound.
std::string error_of_faults(const std::filesystem::path& folder, const std::string& faults) {
  const auto file = folder / "scenario.yaml";
  std::ofstream(file)
      << "name: s\ndescription: d\nsource: t\nmachine: hexapod\nprogram: line.gcode\nas_built: nominal\n"
         "seed: 1\ngap_control: off\nengine: quasistatic\nexpect:\n"
         "  - {metric: verdict, equals: go, source: t}\n"
      << faults;
  try {
    load_scenario(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ScenarioFaults, AreReadStrictly) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "scenario_faults";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "line.gcode") << "G21\n";
  EXPECT_EQ(error_of_faults(folder, "faults:\n  - {fault: lost_steps, axis: l1, at_s: 1, steps: 8}\n"),
            "accepted");
  EXPECT_EQ(error_of_faults(folder, "faults:\n  - {fault: power_cut, at_s: 1}\n"), "accepted");
  EXPECT_EQ(error_of_faults(folder, "faults:\n  - {fault: loose_joint, axis: l1, at_s: 1, play_um: 20}\n"),
            "accepted");
  EXPECT_THAT(error_of_faults(folder, "faults:\n  - {fault: lost_step, axis: l1, at_s: 1, steps: 8}\n"),
              AllOf(HasSubstr("scenario.yaml:13"), HasSubstr("did you mean 'lost_steps'?")));
  EXPECT_THAT(error_of_faults(folder, "faults:\n  - {fault: lost_steps, axis: l1, at_s: -1, steps: 8}\n"),
              HasSubstr("at_s is -1 s, below 0 s"));
  EXPECT_EQ(error_of_faults(folder, "faults:\n  - {fault: lost_steps, axis: l1, at_s: 1, steps: 1000000}\n"),
            "accepted");
  EXPECT_THAT(
      error_of_faults(folder, "faults:\n  - {fault: lost_steps, axis: l1, at_s: 1, steps: 1000004}\n"),
      AllOf(HasSubstr("scenario.yaml:13"), HasSubstr("steps is 1000004, outside 0 to 1000000")));
  EXPECT_THAT(error_of_faults(folder, "faults:\n  - {fault: stall, axis: l1, at_s: 1}\n"),
              HasSubstr("for_s' is missing"));
  EXPECT_THAT(error_of_faults(folder, "faults:\n  - {fault: power_cut, axis: l1, at_s: 1}\n"),
              HasSubstr("unknown key 'faults[1].axis'"));
  EXPECT_THAT(error_of_faults(
                  folder, "faults:\n  - {fault: thermal_growth, axis: l1, at_s: 1, over_s: 5, growth: 3}\n"),
              HasSubstr("growth_um"));
  EXPECT_THAT(error_of_faults(folder, "faults: []\n"), HasSubstr("at least one"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace understudy::regression
