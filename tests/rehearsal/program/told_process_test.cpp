#include "rehearsal/program/told_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

using Facts = std::map<std::string, std::string>;

machine::Tool nozzle_of(double bore_mm) {
  machine::Tool tool;
  tool.nozzle_diameter = from_mm(bore_mm);
  tool.flat_diameter = from_mm(bore_mm + 0.6);
  tool.filament_diameter = 1.75e-3;
  return tool;
}

TEST(ToldProcess, ANozzleThatIsMountedKeepsTheWidthOfTheFlatRing) {
  machine::Tool tool = nozzle_of(0.4);
  mount_nozzle(tool, 0.8e-3);
  EXPECT_DOUBLE_EQ(tool.nozzle_diameter, 0.8e-3);
  EXPECT_NEAR(tool.flat_diameter, 1.4e-3, 1e-15);
}

TEST(ToldProcess, AnotherNozzleThanTheSlicersIsAWarning) {
  const auto warnings = process_warnings({}, nozzle_of(0.4), {{"nozzle_diameter", "0.8,0.8"}}, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].severity, Severity::warning);
  EXPECT_EQ(warnings[0].value, 0.8);
  EXPECT_NEAR(warnings[0].limit, 0.4, 1e-12);
  EXPECT_THAT(warnings[0].message, HasSubstr("sliced for a nozzle of 0.8 mm, rehearsed with one of 0.4 mm"));
  EXPECT_THAT(process_warnings({}, nozzle_of(0.4), {{"nozzle_diameter", "0.4"}}, 0), IsEmpty());
  EXPECT_THAT(process_warnings({}, nozzle_of(0.4), {{"nozzle_diameter", "wide"}}, 0), IsEmpty());
  EXPECT_THAT(process_warnings({}, nozzle_of(0.4), {}, 0), IsEmpty());
}

TEST(ToldProcess, AnotherFilamentThanTheSlicersIsAWarning) {
  const auto warnings = process_warnings({}, nozzle_of(0.4), {{"filament_diameter", "3"}}, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].message, HasSubstr("sliced for filament of 3 mm, rehearsed with one of 1.75 mm"));
  EXPECT_THAT(process_warnings({}, nozzle_of(0.4), {{"filament_diameter", "1.78,1.75"}}, 0), IsEmpty());
}

TEST(ToldProcess, AnotherMaterialThanTheSlicersIsAWarning) {
  const auto warning = other_material("pla", {{"material", "ABS;ABS"}});
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->severity, Severity::warning);
  EXPECT_THAT(warning->message, HasSubstr("sliced for ABS;ABS, judged as pla"));
  EXPECT_TRUE(other_material("pla", {{"material", "PETG"}}));
  for (const char* same : {"PLA", "PLA+", "pla,pla", "\"PLA\";\"PLA\""})
    EXPECT_FALSE(other_material("pla", {{"material", same}})) << same;
  EXPECT_FALSE(other_material("pla", {}));
}

TEST(ToldProcess, TheLayerIsTheRequestsElseTheComments) {
  DialectRequest dialect;
  EXPECT_EQ(told_layer(dialect, {}), 0);
  EXPECT_EQ(told_layer(dialect, {{"layer_height", "-1"}}), 0);
  EXPECT_NEAR(told_layer(dialect, {{"layer_height", "0.28"}}), 0.28e-3, 1e-12);
  dialect.layer_mm = 0.3;
  EXPECT_NEAR(told_layer(dialect, {{"layer_height", "0.28"}}), 0.3e-3, 1e-12);
  EXPECT_THAT(process_warnings(dialect, nozzle_of(0.4), {}, 0.31e-3), IsEmpty());
  const auto warnings = process_warnings(dialect, nozzle_of(0.4), {}, 0.45e-3);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].message,
              HasSubstr("most of the path lies 0.450 mm over what is below, not 0.3 mm"));
}

// 20 mm of bead of 0.45 x 0.2 mm are 1.628 mm3, of filament of 1.75 mm 0.6769 mm.
TEST(ToldProcess, FilamentThatDoesNotMakeTheToldBeadsIsAWarning) {
  const std::string start = "M83\n;HEIGHT:0.2\n;WIDTH:0.45\nG1 X20 F600 ";
  machine::MachineDescription machine;
  machine.tool = nozzle_of(0.4);
  const auto warning = [&](const std::string& text) {
    return other_flow(toolpath::parse_gcode(text, "p", {}), machine, toolpath::ToldBeads(text));
  };
  EXPECT_FALSE(warning(start + "E0.677\n").has_value());
  EXPECT_FALSE(warning(start + "E0.61\n").has_value()) << "a flow of 90 %";
  const auto starved = warning("M221 S60\n" + start + "E0.677\n");
  ASSERT_TRUE(starved.has_value());
  EXPECT_EQ(starved->severity, Severity::warning);
  EXPECT_EQ(starved->gcode_line, 5);
  EXPECT_NEAR(starved->value, 60, 0.1);
  EXPECT_FALSE(warning("M83\nG1 X20 F600 E5\n").has_value()) << "nothing is told";
}

}  // namespace
}  // namespace understudy::rehearsal
