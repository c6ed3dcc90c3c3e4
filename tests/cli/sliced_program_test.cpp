// A part as a slicer writes it with its default profile, whole and spoilt as operators spoil parts. The
// shipped box is PrusaSlicer's; its first layers tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kSource = UNDERSTUDY_SOURCE_DIR;
constexpr int kLayers = 5;

/// The box up to its fifth layer, with `from` replaced by `to` wherever it stands.
std::string first_layers(const std::string& from = "", const std::string& to = "") {
  std::string text = read_file(kSource + "/scenarios/planar/box.gcode");
  std::size_t end = 0;
  for (int layer = 0; layer <= kLayers; ++layer) end = text.find(";LAYER_CHANGE", end) + 1;
  text.resize(end - 1);
  for (std::size_t at = 0; !from.empty() && (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

Outcome rehearse(const std::string& program, const std::string& options = "") {
  const Folder folder;
  const std::string file = folder.write("box.gcode", program);
  return understudy("rehearse " + file +
                    " --machine five-axis --material pla --engine quasistatic --no-pictures " + options +
                    " --out " + (folder / "out"));
}

TEST(SlicedProgram, AsItIsIsAGo) {
  const Outcome whole = rehearse(first_layers());
  EXPECT_EQ(whole.status, 0) << whole.out;
}

TEST(SlicedProgram, AFirstLayerThatIsTooHighDoesNotStick) {
  const Outcome high = rehearse(first_layers(), "--place 0,0,0.15");
  EXPECT_EQ(high.status, 1);
  EXPECT_THAT(high.out, HasSubstr("does not stick"));
}

TEST(SlicedProgram, ThreeFifthsOfTheFlowLeaveVoids) {
  const Outcome thin = rehearse(first_layers("\nM83", "\nM221 S60\nM83"));
  EXPECT_EQ(thin.status, 1);
  EXPECT_THAT(thin.out, HasSubstr("neighbouring lines leave voids"));
}

// PLA at 210 C in the slicer's profile, and from 180 C on at all.
TEST(SlicedProgram, FortyKelvinAreTooCold) {
  const Outcome cold = rehearse(first_layers("S210", "S170"));
  EXPECT_EQ(cold.status, 1);
  EXPECT_THAT(cold.out, HasSubstr("filament is fed at 170 C, below the lowest"));
}

TEST(SlicedProgram, OverAClampTheNozzleTouches) {
  const Outcome clamp = rehearse(first_layers(), "--fixture slanted_box");
  EXPECT_EQ(clamp.status, 1);
  EXPECT_THAT(clamp.out, HasSubstr("nozzle touches part"));
}

TEST(SlicedProgram, WhatIsFedAtRestInTheAirIsPurgedAndInNobodysWay) {
  const Outcome primed =
      rehearse(first_layers("\n;LAYER_CHANGE", "\nG1 X0 Y0 Z30 F1200\nG1 E3 F200\n;LAYER_CHANGE"));
  EXPECT_EQ(primed.status, 0) << primed.out;
  EXPECT_THAT(primed.out, HasSubstr(" mm purged"));
  EXPECT_THAT(primed.out, ::testing::Not(HasSubstr(" 0.0 mm purged")));
}

}  // namespace
}  // namespace understudy::cli_test
