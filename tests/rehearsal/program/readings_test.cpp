// Programs of rotary words that were written for a machine of another kind: a ring printed square to its
// surface, told as the slides of several machines. The slides are worked out here, rotation by rotation.
#include "rehearsal/program/readings.h"

#include <filesystem>
#include <fstream>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using ::testing::HasSubstr;

Mat3 about(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// Around a torus beside the origin, as a program for these machines; lengths in mm, the pivot 60 mm above
/// the tip. A pivot offsets the surface, which of a sphere would be another sphere. E keeps the beads even.
std::string ring(const std::string& machine) {
  std::string text = "M104 S200\nM83\n";
  const Vec3 up(0, 0, 1), pivot(0, 0, -60);
  Vec3 before = Vec3::Zero();
  for (double lean = 15; lean <= 39; lean += 3)
    for (int i = 0; i <= 60; ++i) {
      // A wave across the rings: a ring alone would not tell the sense of C.
      const double c = 2 * std::numbers::pi * i / 60, b = from_deg(lean + 2 * std::sin(5 * c));
      const Mat3 head = about(Vec3::UnitY(), b), table = about(up, c), both = table * head;
      const Vec3 tip = Vec3(3, -4, 5) + 15 * (table * Vec3::UnitX()) + 8 * (both * up);
      Vec3 p = tip;
      if (machine == "crossing") p = both.transpose() * tip;
      if (machine == "head") p = table.transpose() * tip - head * pivot + pivot;
      if (machine == "double-head") p = tip - both * pivot + pivot;
      text +=
          fmt::format("G{} X{:.5f} Y{:.5f} Z{:.5f} B{:.5f} C{:.5f}{} F600\n", i ? 1 : 0, p.x(), p.y(), p.z(),
                      to_deg(b), to_deg(c), i ? fmt::format(" E{:.5f}", 0.03 * (tip - before).norm()) : "");
      before = tip;
    }
  return text;
}

toolpath::GcodeOptions five_axis() { return control::gcode_options({}, machine::load_machine("five-axis")); }

TEST(Readings, TheKindOfMachineAndItsPivotAreFoundFromThePath) {
  for (const std::string machine : {"tip", "crossing", "head", "double-head"}) {
    const RotaryReading best = rank_readings({"p.gcode", ring(machine)}, five_axis()).front();
    const bool head = machine.ends_with("head");
    EXPECT_EQ(best.coordinates.substr(0, machine.size()), machine);
    EXPECT_EQ(best.b_sign, 1) << machine;
    EXPECT_EQ(best.c_sign, 1) << machine;
    EXPECT_LT(to_deg(best.quality.out_of_layer), 2) << machine;
    // E has five digits, and moves are chords.
    if (!head) continue;
    EXPECT_NEAR(std::stod(best.coordinates.substr(machine.size() + 1)), 60, 0.5) << machine;
  }
}

/// A hub of upright layers, and blades that stand off its side: printed with the tool leaning by 80 degrees,
/// in layers that wave. The slides of a machine whose axes cross, which counts B and C the other way round.
std::string propeller(int b_sign, int c_sign) {
  std::string text = "M104 S200\nM83\n";
  Vec3 before = Vec3::Zero();
  const auto go = [&](const Vec3& tip, double b, double c, bool prints) {
    const Vec3 p = (about(Vec3::UnitZ(), c) * about(Vec3::UnitY(), b)).transpose() * tip;
    text += fmt::format("G{} X{:.5f} Y{:.5f} Z{:.5f} B{:.5f} C{:.5f}{} F600\n", prints ? 1 : 0, p.x(), p.y(),
                        p.z(), b_sign * to_deg(b), c_sign * to_deg(c),
                        prints ? fmt::format(" E{:.5f}", 0.03 * (tip - before).norm()) : "");
    before = tip;
  };
  for (double z = 0.2; z <= 16; z += 0.2)
    for (int i = 0; i <= 60; ++i) {
      const double a = 2 * std::numbers::pi * i / 60;
      go({6 * std::cos(a), 6 * std::sin(a), z}, 0, 0, i > 0);
    }
  for (int blade = 0; blade < 3; ++blade)
    for (double r = 6.2; r <= 12; r += 0.2)
      for (int i = 0; i <= 60; ++i) {
        const double c = 2 * std::numbers::pi * blade / 3 + 0.5 * std::sin(0.1 * i), z = 3 + 0.15 * i;
        const double off = r + 0.6 * std::sin(0.7 * i);
        const double beside = c + 0.3 * std::sin(0.37 * i);  // else a mirror image would be as good
        go({off * std::cos(beside), off * std::sin(beside), z}, from_deg(80), c, i > 0);
      }
  return text;
}

TEST(Readings, BladesThatLieOnTheirHubTellTheSignsOfBothTurns) {
  for (const int b : {1, -1})
    for (const int c : {1, -1}) {
      const RotaryReading best = rank_readings({"p.gcode", propeller(b, c)}, five_axis()).front();
      EXPECT_EQ(best.coordinates, "crossing") << b << ' ' << c;
      EXPECT_EQ(best.b_sign, b) << b << ' ' << c;
      EXPECT_EQ(best.c_sign, c) << b << ' ' << c;
      EXPECT_LT(best.floating, 0.002);
    }
}

// Read as axes that cross, the first line that fails is G43.4, which says nothing about the program.
TEST(Readings, WhereNoneIsPossibleTheFirstReadingSaysWhy) {
  const std::string text = "M104 S200\nM83\nG43.4\nG1 X1 B2 C3 E1 F600\nG1 X2 X3 E1\n";
  try {
    rank_readings({"p.gcode", text}, five_axis());
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:5:7: 'X3': the line has a second X"));
  }
}

TEST(Readings, FilamentInOtherUnitsIsSaid) {
  std::string text = "M104 S200\nM83\n";
  for (int i = 0; i <= 30; ++i) text += fmt::format("G1 X{} B{} C0 E41 F600\n", i, i);
  try {
    rank_readings({"p.gcode", text}, five_axis());
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mm of filament on 1 mm of path (median), at most 10 are a bead"));
  }
}

TEST(Readings, AHeadsSlidesAreTurnedIntoTheTip) {
  toolpath::GcodeOptions options = five_axis();
  options = read_as({"head:60", 1, 1, {}}, options);
  const auto tip = [&](const std::string& line) -> Vec3 {
    return 1e3 * toolpath::parse_gcode(line, "p", options).steps.back().X_WT.translation();
  };
  // The head leans to +x by 90 degrees: the tip swings from 60 mm below the pivot to 60 mm before it, to -x.
  EXPECT_LT((tip("G0 X10 Y0 Z5 B90 C0") - Vec3(10 - 60, 0, 5 + 60)).norm(), 1e-9);
  // The table carries it on by a quarter, and with both on the head the pivot stays.
  EXPECT_LT((tip("G0 X10 Y0 Z5 B90 C90") - Vec3(0, 10 - 60, 65)).norm(), 1e-9);
  options = read_as({"double-head:60", 1, 1, {}}, five_axis());
  EXPECT_LT((tip("G0 X10 Y0 Z5 B90 C90") - Vec3(10, -60, 65)).norm(), 1e-9);
}

class Misread : public testing::Test {
 protected:
  Record run(const std::string& text, const std::string& coordinates) {
    const std::string file = (folder_ / "p.gcode").string();
    std::ofstream(file) << text;
    RehearsalRequest request;
    request.program = file;
    request.machine = "five-axis";
    request.engine = "quasistatic";
    request.keep_scene = false;
    request.dialect.coordinates = coordinates;
    request.dialect.place_mm = {0, 0, 20};
    return rehearse(request);
  }
  static const Finding* reading_of(const Record& record) {
    for (const Finding& finding : record.findings)
      if (finding.kind == "reading") return &finding;
    return nullptr;
  }
  TemporaryFolder folder_;
};

TEST_F(Misread, AHeadTiltOnATableIsANoGoThatNamesTheReading) {
  const Record record = run(ring("head"), "");
  const Finding* finding = reading_of(record);
  ASSERT_NE(finding, nullptr);
  EXPECT_FALSE(record.go);
  EXPECT_EQ(finding->severity, Severity::error);
  EXPECT_THAT(finding->message, HasSubstr("read as `--coordinates head:"));
  EXPECT_THAT(finding->message, HasSubstr("`understudy inspect " + (folder_ / "p.gcode").string() +
                                          " --machine five-axis` ranks the readings"));
}

TEST_F(Misread, TheRightReadingIsNoFinding) {
  EXPECT_EQ(reading_of(run(ring("tip"), "")), nullptr);
  EXPECT_EQ(reading_of(run(ring("head"), "head:60")), nullptr);
}

TEST_F(Misread, WordsThatMeanNothingHereAreRefusedWithTheCommandThatSaysMore) {
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      run(text, "");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string offer =
      "; `understudy inspect " + (folder_ / "p.gcode").string() + " --machine five-axis`";
  EXPECT_THAT(refusal("G0 X1 A5\n"), HasSubstr(offer));
  EXPECT_THAT(refusal("START_PRINT\nG0 X1\n"), HasSubstr(offer));
  EXPECT_THAT(refusal("G0 X1.2.3\n"), Not(HasSubstr("understudy inspect")));
}

TEST(Coordinates, WordsThatAreNoneAreRefused) {
  for (const char* word : {"tips", "head", "head:", "head:x", "head:60mm", "head:6000", "double-head:nan"})
    EXPECT_THROW(read_as({word, 1, 1, {}}, five_axis()), InputError) << word;
}

}  // namespace
}  // namespace understudy::rehearsal
