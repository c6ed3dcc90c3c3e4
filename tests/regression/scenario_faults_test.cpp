#include "regression/scenario_faults.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "regression/scenario_file.h"
#include "tests/temporary_folder.h"

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
  const TemporaryFolder scratch;
  const std::filesystem::path& folder = scratch.path();
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
}

TEST(ScenarioCameraFaults, AreReadStrictly) {
  const TemporaryFolder scratch;
  const std::filesystem::path& folder = scratch.path();
  std::ofstream(folder / "line.gcode") << "G21\n";
  const auto error_of = [&](const std::string& fault) {
    return error_of_faults(folder, "camera_faults:\n  - {" + fault + "}\n");
  };
  for (const char* fault :
       {"fault: dark, at_s: 1", "fault: lost, at_s: 1, share: 0.3", "fault: dim, at_s: 0, power: 0.05",
        "fault: saturated, at_s: 0, power: 4", "fault: ghost, at_s: 1, gap_offset_um: 40",
        "fault: cut_beam, at_s: 1, offset_px: 2, direction_deg: 90",
        "fault: strip, at_s: 1, offset_px: -10, direction_deg: 0", "fault: displaced, at_s: 1, offset_px: 8"})
    EXPECT_EQ(error_of(fault), "accepted") << fault;
  EXPECT_THAT(error_of("fault: drak, at_s: 1"),
              AllOf(HasSubstr("scenario.yaml:13"), HasSubstr("did you mean 'dark'?")));
  EXPECT_THAT(error_of("fault: dark, at_s: -1"), HasSubstr("at_s is -1 s, below 0 s"));
  EXPECT_THAT(error_of("fault: lost, at_s: 1, share: 1.5"), HasSubstr("share is 1.5"));
  EXPECT_THAT(error_of("fault: dim, at_s: 1"), HasSubstr("power' is missing"));
  EXPECT_THAT(error_of("fault: dark, at_s: 1, power: 0.5"),
              HasSubstr("unknown key 'camera_faults[1].power'"));
}

}  // namespace
}  // namespace understudy::regression
