#include "rehearsal/program/programmed_layers.h"

#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/program/printer.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

/// Rows of 20 mm, 0.386 mm apart, at each of these heights [mm]; 0.1157 mm2 of bead.
std::string rows(const std::vector<double>& heights) {
  std::string text = "M83\nG1 F600\n";
  for (const double z : heights)
    for (int i = 0; i < 10; ++i) text += fmt::format("G0 X0 Y{0} Z{1}\nG1 X20 Y{0} E2.314\n", 0.386 * i, z);
  return text;
}

ProgrammedLayers layers_of(const std::string& text) {
  return {toolpath::parse_gcode(text, "p", {}), printer(), nullptr};
}

TEST(ProgrammedLayers, AreTheHeightsOverWhatTheProgramLaidBefore) {
  const ProgrammedLayers layers = layers_of(rows({0.2, 0.5, 0.8, 1.1}));
  EXPECT_NEAR(layers.typical_layer(), 0.3e-3, 1e-6);
  EXPECT_NEAR(layers.band(4).low, 0.1e-3, 1e-6) << "a first layer of 0.2 mm";
  EXPECT_NEAR(layers.band(70).low, 0.15e-3, 1e-6);
}

// The extruder lags, so filament still flows as the nozzle leaves.
TEST(ProgrammedLayers, ATravelHasTheLayerOfTheLineBeforeIt) {
  const ProgrammedLayers layers = layers_of(rows({0.06}) + "G0 Z10\nM400\nG0 X0\n");
  const double low = 0.06e-3 * 0.1 / 0.13;  // accepted_min over aim
  EXPECT_NEAR(layers.band(22).low, low, 1e-6) << "the last line that is printed";
  EXPECT_NEAR(layers.band(23).low, low, 1e-6) << "up from it";
  EXPECT_NEAR(layers.band(25).low, low, 1e-6);
  EXPECT_NEAR(layers.band(1).low, 0.1e-3, 1e-9) << "nothing was printed yet";
}

// As a program's jumps do whose rotary words are meant for another kind of machine.
TEST(ProgrammedLayers, MuchFilamentOnHardlyAnyPathMakesNoLine) {
  const ProgrammedLayers layers = layers_of(rows({0.2}) + "G1 X20.06 Z0.23 E8\n" + rows({0.5}));
  EXPECT_NEAR(layers.band(44).low, 0.15e-3, 1e-6) << "0.3 mm above the first";
}

TEST(ProgrammedLayers, ALineOverAHollowHasTheLayerOfThoseBeside) {
  std::string text = rows({0.2, 0.5});
  text += "G0 X0 Y10 Z0.8\nG1 X20 E2.314\n" + rows({0.8}).substr(12);
  EXPECT_NEAR(layers_of(text).band(44).low, 0.15e-3, 1e-6) << "0.8 mm above the table";
}

/// Rows 0.7 mm apart on a level layer, from 0.15 to 0.4 mm higher, each with the filament of its height; or
/// all with that of the lowest.
std::string wedge(bool starved) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    const double h = 0.15 + 0.05 * i, volume = 20 * 0.7 * (starved ? 0.15 : h);  // [mm], [mm3]
    text += fmt::format("G0 X0 Y{0} Z{1}\nG1 X20 Y{0} Z{1} E{2}\n", 0.1 + 0.7 * i, 0.2 + h, volume);
  }
  return text;
}

TEST(ProgrammedLayers, AWedgeIsAsHighAtEachLineAsItsFilamentIsEnoughFor) {
  const ProgrammedLayers layers = layers_of(rows({0.2}) + wedge(false));
  for (int i = 3; i < 6; ++i) {
    const double h = 0.15e-3 + 0.05e-3 * i;
    EXPECT_GT(layers.band(24 + 2 * i).high, h) << i;
    EXPECT_LT(layers.band(24 + 2 * i).high, h + 0.1e-3) << i;
  }
  EXPECT_LT(layers_of(rows({0.2}) + wedge(true)).band(24 + 2 * 5).high, 0.4e-3)
      << "filament of 0.15 mm does not reach 0.4 mm";
}

/// With the comments of PrusaSlicer, layers as high as told but for the last, which lies `lower` [mm], and
/// lines 0.45 mm wide; filament of `flow`.
std::string told_rows(const std::vector<double>& layers, double flow = 1, double lower = 0) {
  std::string text = "M83\nG1 F600\n;TYPE:Perimeter\n;WIDTH:0.45\n";
  double z = 0;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const double h = layers[n], volume = 20 * ((0.45 - h) * h + std::numbers::pi / 4 * h * h) * flow;
    z += h - (n + 1 == layers.size() ? lower : 0);
    text += fmt::format(";HEIGHT:{}\nG0 X0 Y0 Z{:.3f}\nG1 X20 E{:.4f}\n", h, z, volume);
  }
  return text;
}

ProgrammedLayers told_layers_of(const std::string& text) {
  return {toolpath::parse_gcode(text, "p", {}), printer(), nullptr, 0, toolpath::ToldBeads(text)};
}

TEST(ProgrammedLayers, LinesOfLayersOfSeveralHeightsHaveTheOnesThatAreTold) {
  const ProgrammedLayers told = told_layers_of(told_rows({0.3, 0.06, 0.3, 0.3, 0.06, 0.3}));
  const double thin = 0.06e-3 * 0.1 / 0.13;  // accepted_min over aim
  for (const int thick_line : {7, 13, 16, 22}) {
    EXPECT_NEAR(told.band(thick_line).low, 0.15e-3, 1e-9) << thick_line;
    EXPECT_GT(told.band(thick_line).high, 0.3e-3) << thick_line;
  }
  for (const int thin_line : {10, 19}) EXPECT_NEAR(told.band(thin_line).low, thin, 1e-9) << thin_line;
}

// By the path alone, a layer of 0.13 mm would be meant.
TEST(ProgrammedLayers, ALineThatLiesLowerThanToldHasTheBandOfWhatIsTold) {
  const std::string text = told_rows({0.3, 0.3, 0.3}, 1, 0.17);
  EXPECT_NEAR(told_layers_of(text).band(13).low, 0.15e-3, 1e-9);
  EXPECT_LT(layers_of(text).band(13).low, 0.13e-3);
}

TEST(ProgrammedLayers, WhatIsToldAndNotFedIsNotBelieved) {
  const std::string starved = told_rows({0.3, 0.3, 0.3}, 0.6);
  EXPECT_EQ(told_layers_of(starved).band(13).high, layers_of(starved).band(13).high);
}

// 0.15 mm of air below a line of 0.3 mm, which 15 % more filament fills in part.
TEST(ProgrammedLayers, OverSupportsALineMayLieHigherThanItIsThick) {
  std::string text = told_rows({0.3, 0.3}) + "G0 Z1.05\nG0 X0 Y0\nG1 X20 E2.661\n";
  EXPECT_NEAR(told_layers_of(text).band(13).low, 0.15e-3, 1e-9);
  text += ";TYPE:Support material\n";
  EXPECT_GT(told_layers_of(text).band(13).low, 0.16e-3);
}

TEST(ProgrammedLayers, WhatHangsInTheAirHasTheBandOfTheMachine) {
  const ProgrammedLayers layers = layers_of(rows({30}));
  EXPECT_EQ(layers.typical_layer(), 0);
  EXPECT_EQ(layers.band(4).high, 0.2e-3);
  EXPECT_EQ(layers.typical_band().high, 0.2e-3);
}

TEST(ProgrammedLayers, AStrutThatRisesFromTheTableHasTheBandOfTheMachine) {
  // Four struts of a lattice, at 60, 12, 45 and 90 degrees to the table.
  std::string text = "M83\nG1 F600\n";
  for (const auto& [x, z] :
       {std::pair(5.0, 8.66), std::pair(10.0, 2.13), std::pair(8.0, 8.0), std::pair(0.0, 10.0)})
    text += fmt::format("G0 Z20\nG0 X0 Y{0}\nG0 Z0.13\nG1 X{0} Z{1} E1.8\n", x, z);
  const ProgrammedLayers layers = layers_of(text);
  EXPECT_EQ(layers.typical_layer(), 0);
  for (const int line : {6, 10, 14, 18}) EXPECT_EQ(layers.band(line).low, 0.1e-3) << line;
}

TEST(ProgrammedLayers, LinesThatTheProgramDoesNotHaveHaveTheBandOfTheMachine) {
  const ProgrammedLayers layers = layers_of(rows({0.3}));
  EXPECT_EQ(layers.band(100000).high, 0.2e-3);
  EXPECT_EQ(layers.band(-1).high, 0.2e-3);
}

}  // namespace
}  // namespace understudy::rehearsal
