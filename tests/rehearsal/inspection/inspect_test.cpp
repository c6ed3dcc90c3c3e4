#include "rehearsal/inspection/inspect.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Inspect : public testing::Test {
 protected:
  std::string file(const std::string& text) const {
    write_file(folder / "p.gcode", text);
    return (folder / "p.gcode").string();
  }
  TemporaryFolder folder;
};

TEST_F(Inspect, AProgramOfAnotherTablesCornerIsPutOnThisOne) {
  const std::string program = file(
      "M83\nSTART_PRINT X=1\nG0 X100 Y100 Z0.3\nG1 X120 E1 F600\nG1 Y110 E1\nM428\nM428\n"
      "; first_layer_temperature = 215,210\n; nozzle_diameter = 0.6\n");
  const Inspection found = inspect(program, "hexapod");
  ASSERT_EQ(found.unknown.size(), 2u);
  EXPECT_EQ(found.unknown[1].word, "M428");
  EXPECT_EQ(found.unknown[1].lines, 2);
  EXPECT_EQ(found.unknown[1].first_line, 6);
  EXPECT_NEAR(found.nozzle.value(), 0.6e-3, 1e-12);
  EXPECT_EQ(
      rehearse_command(found.request, "out"),
      "understudy rehearse " + program +
          " --machine hexapod --place -110,-105,0 --ignore START_PRINT,M428 --temperature 215 --nozzle 0.6 "
          "--out out");
}

TEST_F(Inspect, FilamentOnALetterOfItsOwnStaysInTheCommand) {
  std::string program = "G21\nG90\nG1 X0 Y0 Z0.2 F1800\n";
  for (int i = 1; i <= 16; ++i) program += fmt::format("G1 X{} A{:.3f}\n", 20 * (i % 2), 0.8 * i);
  const Inspection found = inspect(file(program), "corexy");
  EXPECT_TRUE(found.foreign_words.empty());
  EXPECT_EQ(found.summary.prints, 16);
  EXPECT_THAT(rehearse_command(found.request, "out"), HasSubstr(" --extruder-letter A "));
}

// The machine's filament of 1.75 mm would be a third of what the slicer counted with.
TEST_F(Inspect, TheFilamentOfTheCommentsIsLoaded) {
  const std::string text = "M104 S200\nM83\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\n; filament_diameter = ";
  EXPECT_THAT(rehearse_command(inspect(file(text + "2.85\n"), "corexy").request, "out"),
              HasSubstr(" --machine 'corexy{tool.filament_diameter_mm: 2.85}' "));
  EXPECT_THAT(rehearse_command(inspect(file(text + "1.75\n"), "corexy").request, "out"),
              HasSubstr(" --machine corexy "));
}

TEST_F(Inspect, RelativeExtrusionOfAMacroIsRecognised) {
  std::string text = "PRINT_START extruder=210\nG1 X0 Y0 Z0.2 F1800\n";
  for (int i = 1; i <= 20; ++i) text += fmt::format("G1 X{} E{}\n", 20 * (i % 2), 0.8 + 0.001 * (i * 7 % 5));
  const Inspection found = inspect(file(text + "; filament used [mm] = 16.04\n"), "corexy");
  ASSERT_TRUE(found.relative_extrusion);
  EXPECT_EQ(found.summary.prints, 20);
  EXPECT_NEAR(found.summary.filament, found.told_filament.value(), 1e-6);
  EXPECT_THAT(rehearse_command(found.request, "out"),
              HasSubstr(" --ignore PRINT_START --relative-extrusion --temperature 210 "));
  EXPECT_FALSE(inspect(file("M83\n" + text), "corexy").relative_extrusion);
}

TEST_F(Inspect, AllRefusedLinesAreToldAndTheirCommandsIgnored) {
  const Inspection found =
      inspect(file("M83\nG29 Q\"\nT3\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\nM428\nG92\n"), "corexy");
  ASSERT_EQ(found.refused.lines, 3);
  EXPECT_EQ(found.refused.told[1].line, 3);
  EXPECT_EQ(found.summary.prints, 1);
  EXPECT_THAT(rehearse_command(found.request, "out"), HasSubstr(" --ignore M428,G29 "));
}

TEST_F(Inspect, ANozzleThatIsHeatedTooLateIsHeatedByTheMacro) {
  const std::string late =
      "M83\nM104 S0\nSTART_PRINT EXTRUDER_TEMP=225 BED_TEMP=60\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\nM104 S200\n";
  EXPECT_THAT(rehearse_command(inspect(file(late), "corexy").request, "out"),
              HasSubstr(" --temperature 225 "));
  EXPECT_THAT(rehearse_command(inspect(file("M109 S200\n" + late.substr(12)), "corexy").request, "out"),
              Not(HasSubstr(" --temperature ")));
}

TEST_F(Inspect, TheMaterialOfTheCommentsIsLoaded) {
  const std::string text = "M83\nSTART\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\n; filament_type = ";
  EXPECT_THAT(rehearse_command(inspect(file(text + "ABS\n"), "corexy").request, "out"),
              HasSubstr(" --temperature 230 --material abs "));
  const Inspection unknown = inspect(file(text + "PETG\n"), "corexy");
  EXPECT_EQ(unknown.told_material, "petg");
  EXPECT_TRUE(unknown.request.material.empty());
}

TEST_F(Inspect, ThreeTurningAxesAreOfNoMachine) {
  const Inspection found = inspect(file("M83\nG0 X-5 Y0 Z0.3\nG1 X5 E1 A5 B6 C7 F600\n"), "corexy");
  EXPECT_EQ(found.foreign_words, "ABC");
  EXPECT_TRUE(found.machines_with_words.empty());
  EXPECT_EQ(found.refused.lines, 0);
  EXPECT_EQ(found.summary.prints, 1);
}

TEST_F(Inspect, FeaturesOfCommentsAreMeasured) {
  const Inspection found = inspect(
      file("M83\nG0 X-5 Y0 Z0.3\n;TYPE:Skirt\nG1 X5 E1 F600\n;TYPE:Perimeter\nG1 Y30 E1\n"), "hexapod");
  ASSERT_EQ(found.feature_lengths.size(), 2u);
  EXPECT_NEAR(found.feature_lengths.at("Skirt"), 10e-3, 1e-12);
  EXPECT_NEAR(found.feature_lengths.at("Perimeter"), 30e-3, 1e-12);
}

TEST_F(Inspect, MacrosAreReadAndStayInTheCommand) {
  const std::string program = file("M83\nSTART_PRINT T=215\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\n");
  const std::string macros = (folder / "printer.cfg").string();
  write_file(macros, "[gcode_macro START_PRINT]\ngcode: M109 S{params.T}\n");
  const Inspection found = inspect(program, "hexapod", macros);
  EXPECT_TRUE(found.unknown.empty());
  EXPECT_NEAR(found.summary.temperatures.at(0), 215 + kCelsiusZero, 1e-9);
  EXPECT_EQ(rehearse_command(found.request, "out"),
            "understudy rehearse " + program + " --machine hexapod --macros " + macros + " --out out");
}

TEST_F(Inspect, WhatTheUserTellsComesAheadOfComments) {
  const std::string program =
      file("M83\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\n; temperature = 215\n; nozzle_diameter = 0.6\n");
  DialectRequest told;
  told.nozzle_mm = 0.8;
  told.layer_mm = 0.3;
  told.temperature_c = 200;
  EXPECT_EQ(
      rehearse_command(inspect(program, "arm", {}, told).request, "p"),
      "understudy rehearse " + program + " --machine arm --temperature 200 --nozzle 0.8 --layer 0.3 --out p");
}

TEST_F(Inspect, LinesThatCannotBeReadAreToldAndTheRestIsRead) {
  const std::string program = file("M104 S200\nM83\nG0 X-5 Y0 Z0.3\nM106 S300\nG1 X5 E1 F600\n");
  const Inspection found = inspect(program, "arm");
  ASSERT_EQ(found.passed_over.size(), 1u);
  EXPECT_EQ(found.passed_over[0].line, 4);
  EXPECT_EQ(found.summary.prints, 1);
}

TEST_F(Inspect, WhatNeedsNothingIsRehearsedAsItIs) {
  const std::string program = file("M104 S200\nM83\nG0 X-5 Y0 Z0.3\nG1 X5 E1 F600\n");
  EXPECT_EQ(rehearse_command(inspect(program, "arm").request, "p"),
            "understudy rehearse " + program + " --machine arm --out p");
}

TEST_F(Inspect, WhatPrintsHighUpMayHaveAPartBelowAndStays) {
  const std::string program = file("M104 S200\nM83\nG0 X-5 Y0 Z31\nG1 X5 E1 F600\n");
  EXPECT_EQ(inspect(program, "hexapod").request.dialect.place_mm[2], 0);
  const std::string below = file("M104 S200\nM83\nG0 X-5 Y0 Z-4.8\nG1 X5 E1 F600\n");
  EXPECT_NEAR(inspect(below, "hexapod").request.dialect.place_mm[2], 5, 1e-9) << "its first layer is 0.2 mm";
}

/// Rings on a dome of 20 mm round a centre beside the origin (one over it would be its own mirror image), the
/// tool square to it, written for a head whose signs and coordinates are these. Seen from the work the tool
/// is turned by Rz(C) Ry(B).
std::string dome(const std::string& coordinates, int b_sign, int c_sign) {
  std::string text = "M104 S200\nM83\nG0 X0 Y0 Z30 B0 C0\n";
  Vec3 before = Vec3::Zero();
  for (double lean = 15; lean <= 45; lean += 3)
    for (int i = 0; i <= 60; ++i) {
      // A wave across the rings: a ring alone would not tell the sense of C.
      const double c = 2 * std::numbers::pi * i / 60, b = from_deg(lean + 2 * std::sin(5 * c));
      const Vec3 axis(std::sin(b) * std::cos(c), std::sin(b) * std::sin(c), std::cos(b));
      const Vec3 tip = Vec3(3, -4, 5) + 20 * axis;
      Vec3 p = tip;
      if (coordinates == "crossing") {
        const Mat3 R =
            (Eigen::AngleAxisd(c, Vec3::UnitZ()) * Eigen::AngleAxisd(b, Vec3::UnitY())).toRotationMatrix();
        p = R.transpose() * p;
      }
      text += fmt::format("G{} X{:.5f} Y{:.5f} Z{:.5f} B{:.5f} C{:.5f}{} F600\n", i ? 1 : 0, p.x(), p.y(),
                          p.z(), b_sign * to_deg(b), c_sign * to_deg(c),
                          i ? fmt::format(" E{:.5f}", 0.03 * (tip - before).norm()) : "");
      before = tip;
    }
  return text;
}

TEST_F(Inspect, TheReadingThatAProgramWasWrittenForIsTheFirst) {
  for (const char* coordinates : {"tip", "crossing"})
    for (const int b : {1, -1})
      for (const int c : {1, -1}) {
        const Inspection found = inspect(file(dome(coordinates, b, c)), "five-axis");
        ASSERT_FALSE(found.readings.empty());
        const RotaryReading& best = found.readings.front();
        EXPECT_EQ(fmt::format("{} {} {}", best.coordinates, best.b_sign, best.c_sign),
                  fmt::format("{} {} {}", coordinates, b, c));
        EXPECT_LT(to_deg(best.quality.out_of_layer), 2);
        EXPECT_NEAR(to_deg(found.summary.tilt_max), 47, 0.1);
      }
}

TEST_F(Inspect, AProgramOfOthersIsReadAsItsPathShows) {
  const fs::path data =
      fs::path(UNDERSTUDY_SOURCE_DIR).parent_path() / "shared/data/five-axis-gcode/simple_curve.gcode";
  if (!fs::exists(data)) GTEST_SKIP() << "the folder shared/data is not beside the repository";
  const Inspection found = inspect(data.string(), "five-axis");
  EXPECT_EQ(found.request.dialect.coordinates, "crossing");
  EXPECT_EQ(found.request.dialect.b_sign, -1);
  EXPECT_EQ(found.request.dialect.c_sign, -1);
  EXPECT_THAT(found.unknown, ElementsAre());
}

/// A line whose table tilts about x and turns.
std::string with_words(const std::string& a, const std::string& c) {
  std::string text = "M104 S200\nM83\nG0 X0 Y0 Z10\n";
  for (int i = 0; i < 30; ++i)
    text += fmt::format("G1 X{} Y{} Z10 {}{} {}{} E0.05 F600\n", i, (i % 2) * 5, a, i, c, 3 * i);
  return text;
}

TEST_F(Inspect, WordsThatTheMachineLacksAreReadForOneThatHasThem) {
  for (const char* machine : {"hexapod", "five-axis"}) {
    const Inspection found = inspect(file(with_words("A", "C")), machine);
    EXPECT_EQ(found.foreign_words, "AC");
    EXPECT_THAT(found.machines_with_words, ::testing::UnorderedElementsAre("trunnion-ac", "arm-positioner"));
    EXPECT_THAT(found.machines_with_words, ::testing::Contains(found.request.machine));
    EXPECT_FALSE(found.readings.empty());
    EXPECT_THAT(rehearse_command(found.request, "o"), HasSubstr(" --machine " + found.request.machine));
  }
  const Inspection tilted = inspect(file(with_words("U", "V")), "arm");
  EXPECT_EQ(tilted.request.machine, "open5x");
  EXPECT_EQ(tilted.rotary_letters, "UV");
}

TEST_F(Inspect, WordsThatNoMachineHasAreReadAsIfTheyTurnedNothing) {
  const Inspection found = inspect(file(with_words("U", "D")), "hexapod");
  EXPECT_EQ(found.foreign_words, "DU");
  EXPECT_TRUE(found.machines_with_words.empty());
  EXPECT_TRUE(found.readings.empty());
  EXPECT_EQ(found.summary.prints, 29);  // the first goes nowhere
  EXPECT_EQ(found.summary.tilt_max, 0);
}

TEST_F(Inspect, TheMachinesOwnCoordinatesNeedNoOption) {
  // On open5x X Y Z are the slides unless the program says otherwise.
  RehearsalRequest request;
  request.program = "p.gcode";
  request.machine = "open5x";
  EXPECT_THAT(rehearse_command(request, "o"), Not(HasSubstr("--coordinates")));
  request.dialect.coordinates = "tip";
  EXPECT_THAT(rehearse_command(request, "o"), HasSubstr("--machine open5x --coordinates tip --out o"));
}

TEST_F(Inspect, WhatCannotBeReadIsRefused) {
  EXPECT_THROW(inspect((folder / "none").string(), "hexapod"), InputError);
  EXPECT_THROW(inspect(file("G0 X1.2.3\n"), "hexapod"), InputError);
}

}  // namespace
}  // namespace understudy::rehearsal
