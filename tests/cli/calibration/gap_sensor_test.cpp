// The calibration of a gap sensor, as a user runs it: pictures of a twin, or his own, to a machine file.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/gap/gap_reading.h"
#include "control/gap/sensor_uncertainty.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "machine/description.h"
#include "sim/as_built/truth.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What a sensor reads where the true one has its dot of `gap`, over a flat [m].
double reads(const machine::MachineDescription& believed, const machine::MachineDescription& truth,
             double gap) {
  vision::DotMeasurement dot;
  control::GapReading reading;
  EXPECT_TRUE(control::dot_pixel(truth.laser, truth.microscope, {}, gap, dot.position_px));
  EXPECT_TRUE(control::read_gap(believed, {}, dot, reading));
  return reading.gap;
}

struct Errors {
  double before = 0, after = 0, sigma = 0;  // [m]
};

/// Of one twin: rendered, calibrated, and compared with the truth at the gap aimed at.
Errors calibrated_twin(int seed, const std::string& options = "") {
  const Folder folder;
  const std::string gaps = folder / "gaps", out = folder / "m.yaml";
  const Outcome sampled =
      understudy("sample-gaps --seed " + std::to_string(seed) + " -o " + gaps + " " + options);
  EXPECT_EQ(sampled.status, 0) << sampled.err;
  const Outcome fitted = understudy("calibrate gap-sensor " + gaps + "/table.csv -o " + out);
  EXPECT_EQ(fitted.status, 0) << fitted.err;
  const auto drawn = machine::load_machine("hexapod"), found = machine::load_machine(out),
             truth =
                 sim::true_description(drawn, sim::make_as_built(drawn, gaps + "/truth/as-built.yaml", 1));
  const double aim = drawn.gap.aim;
  return {reads(drawn, truth, aim) - aim, reads(found, truth, aim) - aim,
          control::calibration_sigma(found, {}, aim)};
}

TEST(GapSensorCommand, PicturesOfATwinGiveAMachineThatReadsTheGap) {
  for (const int seed : {5, 6}) {
    const Errors e = calibrated_twin(seed, "--feeler-sigma 2");
    EXPECT_GT(std::abs(e.before), 20e-6) << "seed " << seed;
    EXPECT_LE(std::abs(e.after), 10e-6) << "seed " << seed;
    EXPECT_LT(std::abs(e.after), 4 * e.sigma) << "seed " << seed;
    EXPECT_LT(e.sigma, 6e-6) << "seed " << seed;
  }
}

TEST(SlowGapSensorCommand, FortyTwinsAreAsNearTheTruthAsTheirFilesState) {
  double before = 0, after = 0, chi_square = 0, worst = 0;
  constexpr int kTwins = 40;
  for (int seed = 1; seed <= kTwins; ++seed) {
    const Errors e = calibrated_twin(seed);
    before += e.before * e.before / kTwins;
    after += e.after * e.after / kTwins;
    chi_square += std::pow(e.after / e.sigma, 2) / kTwins;
    worst = std::max(worst, std::abs(e.after));
  }
  std::printf("before %.1f um RMS, after %.2f um RMS, %.2f um at most, chi-square %.2f\n",
              to_um(std::sqrt(before)), to_um(std::sqrt(after)), to_um(worst), chi_square);
  EXPECT_LE(std::sqrt(after), 10e-6);
  EXPECT_GT(chi_square, 0.4);  // the mean of 40 squares: 1 +- 0.22, 2.7 sigma
  EXPECT_LT(chi_square, 1.6);
}

TEST(GapSensorCommand, SaysWhatItFoundAndWhatThePicturesDoNotShow) {
  const Folder folder;
  const std::string gaps = folder / "gaps";
  ASSERT_EQ(understudy("sample-gaps --no-speckle --heights 0.1,0.3,0.5,0.7,0.9,1.1 -o " + gaps).status, 0);
  EXPECT_TRUE(fs::exists(gaps + "/dot-006.png"));
  EXPECT_THAT(read_file(gaps + "/truth/gaps.csv"), HasSubstr("dot-006.png,"));
  const Outcome outcome = understudy("calibrate gap-sensor " + gaps + "/table.csv -o " + (folder / "m.yaml"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("6 of 6 pictures at 6 heights over 1.00 mm"), HasSubstr("camera turn z"),
                    HasSubstr("the pictures do not show these, which keep their tolerance:"),
                    HasSubstr("1 sigma calibrated"), HasSubstr("machine: ")));
  EXPECT_THAT(read_file(folder / "m.yaml"), HasSubstr("\ngap_sensor:\n"));
}

TEST(GapSensorCommand, EqualSeedsGiveEqualPicturesAndOtherSeedsOtherTruths) {
  const Folder folder;
  const auto sampled = [&](const std::string& name, int seed) {
    EXPECT_EQ(
        understudy("sample-gaps --heights 0.1 --seed " + std::to_string(seed) + " -o " + (folder / name))
            .status,
        0);
    return read_file(folder / (name + "/dot-001.png")) + read_file(folder / (name + "/truth/as-built.yaml"));
  };
  const std::string a = sampled("a", 3);
  EXPECT_EQ(a, sampled("b", 3));
  EXPECT_NE(a, sampled("c", 4));
}

/// The twin is built from the drawing: its dots do not move when the controller learns where they are.
TEST(ExtendedGapSensorCommand, TheTwinStaysWhatItIsWhenItsControllerIsCalibrated) {
  const Folder folder;
  ASSERT_EQ(understudy("sample-gaps --seed 3 -o " + (folder / "gaps")).status, 0);
  ASSERT_EQ(
      understudy("calibrate gap-sensor " + (folder / "gaps/table.csv") + " -o " + (folder / "m.yaml")).status,
      0);
  ASSERT_EQ(understudy("sample-gaps --seed 3 --machine " + (folder / "m.yaml") + " -o " + (folder / "again"))
                .status,
            0);
  for (const char* picture : {"dot-001.png", "dot-010.png"})
    EXPECT_EQ(read_file(folder / ("gaps/" + std::string(picture))),
              read_file(folder / ("again/" + std::string(picture))));
}

TEST(GapSensorCommand, BadInputIsOneLineAndNothingIsWritten) {
  const Folder folder;
  const std::string out = " -o " + (folder / "m.yaml");
  const auto refused = [&](const std::string& words, const char* why) {
    const int before = folder.entries();
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(folder.entries(), before) << words;
  };
  refused("calibrate gap-sensor " + (folder / "none.csv") + out, "none.csv");
  folder.write("t.csv", "height_mm,picture,gap_mm,gap_sigma_um\n0.1,a.png,0.1,5\n");
  refused("calibrate gap-sensor " + (folder / "t.csv") + out, "t.csv: pictures at 1 heights");
  refused("calibrate gap-sensor " + (folder / "t.csv"), "--output is required");
  refused("calibrate gap-sensor", "table is required");
  refused("calibrate gap-sensor " + (folder / "t.csv") + " --machine arm" + out,
          "has no laser and microscope");
  refused("calibrate" + out, "measurements is required");
  refused("sample-gaps --heights 9 -o " + (folder / "g"), "--heights 9 is outside 0.02 to 5 mm");
  refused("sample-gaps --machine arm -o " + (folder / "g"), "has no laser and microscope");
}

TEST(GapSensorCommand, HelpHasAnExample) {
  const Outcome help = understudy("calibrate gap-sensor --help");
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("Example: understudy calibrate gap-sensor"), HasSubstr("height_mm"),
                              Not(HasSubstr("--estimator"))));
}

}  // namespace
}  // namespace understudy::cli_test
