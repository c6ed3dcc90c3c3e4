// Syntax: Klipper, "Command templates" (Macro parameters, G-Code commands) and "Config reference",
// [gcode_macro].
#include "toolpath/gcode/macros/gcode_macros.h"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/complaint.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kRounding = 1e-12;

/// The form of Klipper's own sample-macros.cfg.
const std::string kStart = R"([printer]
kinematics: corexy   # not a macro
[gcode_macro START_PRINT]
description: heat and go
gcode:
    {% set BED_TEMP = params.BED_TEMP|default(60)|float %}
    {% set EXTRUDER_TEMP = params.EXTRUDER_TEMP|default(190)|float %}
    # the bed
    M140 S{BED_TEMP}
    G90
    SET_GCODE_OFFSET Z=0.0
    G28
    G1 Z5 F3000
    M109 S{EXTRUDER_TEMP}
[gcode_macro park]
gcode: G0 X{params.X|default(-10)|int} Y{ params.Y | default( 20 ) } ; out of the way
)";

std::vector<std::string> texts(const std::vector<MacroLine>& lines) {
  std::vector<std::string> result;
  for (const MacroLine& line : lines) result.push_back(line.text);
  return result;
}

std::vector<std::string> expand(const std::string& file, const std::string& command,
                                const std::string& call) {
  MacroBudget left;
  return texts(GcodeMacros::parse(file, "m.cfg").expand(command, call, left));
}

Program parse(const std::string& text, const std::string& macros) {
  GcodeOptions options;
  options.macros = std::make_shared<GcodeMacros>(GcodeMacros::parse(macros, "m.cfg"));
  return parse_gcode(text, "p.gcode", options);
}

std::string rejection(const std::string& text, const std::string& macros) {
  return complaint([&] { parse(text, macros); });
}
std::string macro(const std::string& lines) { return "[gcode_macro A]\ngcode:\n  G0 X1\n" + lines; }

TEST(GcodeMacros, ParametersOfTheCallOrTheirDefaultsTakeTheirPlaces) {
  EXPECT_THAT(expand(kStart, "PARK", "PARK"), ElementsAre("G0 X-10 Y20 "));
  EXPECT_THAT(expand(kStart, "PARK", "N3 park x=7.9 Y=\"1\" ; there"), ElementsAre("G0 X7 Y1 "));
  EXPECT_THAT(expand(kStart, "START_PRINT", "START_PRINT EXTRUDER_TEMP=215 BED_TEMP=55.5"),
              ElementsAre("M140 S55.5", "G90", "SET_GCODE_OFFSET Z=0.0", "G28", "G1 Z5 F3000", "M109 S215"));
  const std::string old = "[gcode_macro M600]\ngcode:\n G0 X{params.X} Y{params.Y}\n";
  EXPECT_THAT(expand(old, "M600", "M600 X5Y6"), ElementsAre("G0 X5 Y6")) << "letters, as of old";
  MacroBudget left;
  EXPECT_EQ(GcodeMacros::parse(kStart, "m.cfg").expand("PARK", "PARK", left).front().number, 16);
}

TEST(GcodeMacros, AProgramRunsTheirLinesAtTheLineOfTheCall) {
  const Program program = parse("G21\nSTART_PRINT EXTRUDER_TEMP=215\nM83\nG1 X5 E1 F600\nPARK\n", kStart);
  ASSERT_EQ(program.steps.size(), 5u);
  EXPECT_EQ(program.steps[0].kind, StepKind::home);
  EXPECT_EQ(program.steps[2].kind, StepKind::temperature);
  EXPECT_NEAR(program.steps[2].temperature, 215 + kCelsiusZero, kRounding);
  for (const std::size_t k : {0u, 1u, 2u}) EXPECT_EQ(program.steps[k].line, 2) << k;
  EXPECT_EQ(program.steps[3].line, 4);
  EXPECT_EQ(program.steps[4].line, 5);
  EXPECT_LT((program.steps[4].X_WT.translation() * 1e3 - Vec3(-10, 20, 5)).norm(), kRounding);
}

TEST(GcodeMacros, WhatTheReaderKnowsItselfKeepsItsMeaning) {
  const std::string macros =
      "[gcode_macro M117]\ngcode:\n {% if rawparams %}\n[gcode_macro M107]\ngcode: M999\n";
  EXPECT_EQ(parse("M117 hello\nM107\nG0 X1\n", macros).steps.size(), 2u);
}

TEST(GcodeMacros, AMacroThatCallsItselfIsRefused) {
  const std::string loop = "[gcode_macro A]\ngcode: B\n[gcode_macro B]\ngcode:\n G0 X1\n A\n";
  EXPECT_THAT(rejection("G0 X1\nA\n", loop),
              StartsWith("p.gcode:2: in A (m.cfg:2): in B (m.cfg:6): macro A calls itself (m.cfg)"));
  EXPECT_THAT(rejection("A\n", "[gcode_macro A]\ngcode: a\n"), HasSubstr("macro A calls itself"));
  EXPECT_EQ(parse("A\nA\n", "[gcode_macro A]\ngcode: G0 X1\n").steps.size(), 2u) << "twice is no loop";
  std::string doubling;
  for (int i = 1; i < 20; ++i)
    doubling += "[gcode_macro B_" + std::to_string(i) + "]\ngcode:\n" +
                (i == 1 ? " G0 X1\n G0 X2\n"
                        : " B_" + std::to_string(i - 1) + "\n B_" + std::to_string(i - 1) + "\n");
  EXPECT_THAT(rejection("B_19\n", doubling), HasSubstr("macros make more than 100000 lines"));
}

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

// A value that stands in a line many times, and so on in the macro that this line calls, would fill any
// memory.
TEST(GcodeMacros, LinesThatGrowWithoutEndAreRefused) {
  const std::string set = "  {% set a = \"" + repeated("x", 30'000) + "\" %}\n";
  EXPECT_THAT(rejection("A\n", macro(set + "  M117 {a}{a}{a}\n")),
              HasSubstr("m.cfg:5: with its values, the line has more than 65536 bytes"));
  EXPECT_THAT(rejection("A\n", macro(set + repeated("  M117 {a}{a}\n", 1'100))),
              HasSubstr("macros make more than 64000000 bytes of one program"));
  EXPECT_THAT(rejection(repeated("A\n", 34), macro(set + repeated("  M117 {a}\n", 66))),
              HasSubstr("macros make more than 64000000 bytes"))
      << "of all calls";
  EXPECT_THAT(rejection(repeated("A\n", 200), macro(repeated("  {% set a = 1 %}\n", 1'000))),
              HasSubstr("macros make more than 100000 lines"))
      << "of nothing, but each of them is read";
}

TEST(GcodeMacros, WhatElseJinjaHasIsRefusedByNameWithFileAndLine) {
  EXPECT_THAT(rejection("G0 X1\nA\n", macro("  {% if printer.x %}\n")),
              StartsWith("p.gcode:2: m.cfg:4: '{% if printer.x %}': of Jinja's statements"));
  EXPECT_THAT(rejection("A\n", macro("  G0 X{printer.toolhead.position.x}\n")),
              StartsWith("p.gcode:1: m.cfg:4: '{printer.toolhead.position.x}': of Jinja, {params.NAME"));
  EXPECT_THAT(rejection("A\n", macro("  G0 X{params.X|default(1) + 1}\n")),
              HasSubstr("m.cfg:4: '{params.X|default(1) +"));
  EXPECT_THAT(rejection("A\n", macro("  G0 X{params.X|round}\n")), HasSubstr("m.cfg:4: '{params.X|round}'"));
  EXPECT_THAT(rejection("A\n", macro("  G0 X{params.X}\n")), HasSubstr("the call does not give it"));
  EXPECT_THAT(rejection("A X=wide\n", macro("  G0 X{params.X|float}\n")), HasSubstr("'wide' is no number"));
  EXPECT_THAT(rejection("A\n", macro("  G0 X{params.X\n")), HasSubstr("not closed on its line"));
  EXPECT_THAT(rejection("A X\n", macro("")), HasSubstr("NAME=VALUE is needed"));
  // Of a macro that is not called, nothing is asked.
  EXPECT_EQ(parse("G0 X1\n", macro("  {% if printer.x %}\n")).steps.size(), 1u);
}

TEST(GcodeMacros, FaultsInTheirLinesAreToldWithBothPlaces) {
  EXPECT_THAT(rejection("G0 X1\nA\n", macro("  G1 Xa\n")),
              StartsWith("p.gcode:2: in A (m.cfg:4): 'Xa': X needs a finite decimal number"));
  EXPECT_THAT(rejection("G0 X1\nA\nA\n", macro("  BEEP\n")), HasSubstr("'BEEP' (2 lines from line 2)"));
}

TEST(GcodeMacros, AFileThatIsNoConfigurationIsRefused) {
  const auto read = [](const std::string& text) {
    return complaint([&] { GcodeMacros::parse(text, "m.cfg"); });
  };
  EXPECT_THAT(read("G28\n"), StartsWith("m.cfg:1: 'G28' is no [section]"));
  EXPECT_THAT(read("\n[gcode_macro A\n"), StartsWith("m.cfg:2: '[gcode_macro A': the section has no ']'"));
  EXPECT_THAT(read("[gcode_macro]\n"), HasSubstr("a macro's name has letters"));
  EXPECT_THAT(read("[gcode_macro A]\n[gcode_macro a]\n"), StartsWith("m.cfg:2: 'A' is there a second time"));
  EXPECT_EQ(read("[include other.cfg]\n[heater_fan x]\npin: PA1\n"), "accepted");
}

}  // namespace
}  // namespace understudy::toolpath
