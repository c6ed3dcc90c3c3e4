// A part as a slicer writes it with its default profile, whole and spoilt as operators spoil parts. The
// shipped box is PrusaSlicer's; its first layers tell.
#include <cstdint>
#include <cstdlib>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

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

/// Of 20 mm, binary.
std::string cube_stl() {
  std::string stl(80, ' ');
  const auto put = [&](auto value) { stl.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::uint32_t{12});
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int half = 0; half < 2; ++half) {
        for (int k = 0; k < 3; ++k) put(0.0F);  // normals are found by the order of corners
        for (int corner = 0; corner < 3; ++corner) {
          // (0,0) (1,0) (1,1) and (0,0) (1,1) (0,1), the other way round on the lower side.
          const int at = side == 1 ? corner : 2 - corner;
          const int u = half == 0 ? (at > 0) : (at == 1), v = half == 0 ? (at > 1) : (at > 0);
          float p[3]{};
          p[axis] = static_cast<float>(20 * side);
          p[(axis + 1) % 3] = static_cast<float>(20 * u);
          p[(axis + 2) % 3] = static_cast<float>(20 * v);
          for (const float coordinate : p) put(coordinate);
        }
        put(std::uint16_t{0});
      }
  return stl;
}

TEST(SlicedProgram, ACubeFreshFromTheSlicerTakesItsTime) {
  if (std::system("command -v prusa-slicer >/dev/null") != 0) GTEST_SKIP() << "prusa-slicer is not installed";
  const Folder folder;
  const std::string stl = folder.write("cube.stl", cube_stl()), cube = folder / "cube.gcode";
  // The default profile with the limits of five-axis.
  const std::string limits = folder.write(
      "limits.ini",
      "gcode_flavor = marlin2\nmachine_max_feedrate_x = 150,150\nmachine_max_feedrate_y = 150,150\n"
      "machine_max_feedrate_z = 30,30\nmachine_max_feedrate_e = 1000,1000\n"
      "machine_max_acceleration_x = 3000,3000\nmachine_max_acceleration_y = 3000,3000\n"
      "machine_max_acceleration_e = 100000,100000\nmachine_max_acceleration_extruding = 1000,1000\n"
      "machine_max_acceleration_retracting = 100000,100000\nmachine_max_acceleration_travel = 1000,1000\n"
      "machine_max_jerk_x = 8,8\nmachine_max_jerk_y = 8,8\nmachine_max_jerk_z = 0.4,0.4\n"
      "machine_max_jerk_e = 1000,1000\ntravel_speed = 100\n");
  ASSERT_EQ(std::system(("prusa-slicer --export-gcode --load " + limits + " --center 0,0 --output " + cube +
                         " " + stl + " >/dev/null 2>&1")
                            .c_str()),
            0);
  const Outcome seen = understudy("inspect " + cube + " --machine five-axis");
  ASSERT_EQ(seen.status, 0) << seen.err;
  const std::size_t at = seen.out.find("for the slicer (");
  ASSERT_NE(at, std::string::npos) << seen.out;
  EXPECT_NEAR(std::stod(seen.out.substr(at + 16)), 0, 3) << seen.out;
  EXPECT_THAT(seen.out, ::testing::Not(HasSubstr("other limits")));
}

TEST(ExtendedSlicedProgram, OverAClampTheNozzleTouches) {
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

/// Layers of several heights, crosswise, 12 mm square, with PrusaSlicer's comments. Those of 0.3 mm lie
/// `lower` [mm] than their comments tell.
std::string layers_of_several_heights(double lower) {
  std::string text = "M104 S210\nM109 S210\nG28\nM83\nM106 S255\n";
  constexpr double kWidth = 0.45, kSide = 12, kQuarterPi = std::numbers::pi / 4;
  double z = 0;
  for (int layer = 0; const double h : {0.2, 0.1, 0.3, 0.1, 0.3, 0.3, 0.1}) {
    z += h;
    text +=
        fmt::format(";LAYER_CHANGE\n;HEIGHT:{}\n;TYPE:Solid infill\n;WIDTH:{}\nG0 Z{}\n", h, kWidth, z + 2);
    const double spacing = kWidth - h * (1 - kQuarterPi), height = h == 0.3 ? z - lower : z;
    const double filament = (spacing * h) * kSide / (kQuarterPi * 1.75 * 1.75);
    for (int row = 0; row * spacing < kSide; ++row) {
      const double across = row * spacing - kSide / 2, along = (row % 2 == 0 ? 1 : -1) * kSide / 2;
      const auto place = [&](double at) {
        return layer % 2 == 0 ? fmt::format("X{:.3f} Y{:.3f}", at, across)
                              : fmt::format("X{:.3f} Y{:.3f}", across, at);
      };
      text += fmt::format("G0 {}\nG0 Z{:.3f}\nG1 {} E{:.5f} F1200\n", place(-along), height, place(along),
                          filament);
    }
    ++layer;
  }
  return text + "G0 Z20\nM104 S0\n";
}

TEST(SlicedProgram, LayersOfSeveralHeightsAreNotJudgedByOne) {
  const Outcome whole = rehearse(layers_of_several_heights(0));
  EXPECT_EQ(whole.status, 0) << whole.out;
}

// The path alone would tell layers of 0.13 and 0.27 mm, each laid as it is.
TEST(SlicedProgram, LayersThatLieLowerThanTheirCommentsTellAreANoGo) {
  EXPECT_EQ(rehearse(layers_of_several_heights(0.17)).status, 1);
}

}  // namespace
}  // namespace understudy::cli_test
