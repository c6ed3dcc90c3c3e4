#include "toolpath/inspection/reading_quality.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

/// A ring round a cone whose side leans by 45 degrees, the tool square to it, or leaning the other way.
ReadingQuality ring(bool square) {
  std::string text = "M83\nG0 X10 Y0 Z5\n";
  for (int i = 0; i <= 100; ++i) {
    const double a = 2 * std::numbers::pi * i / 100, s = std::sqrt(0.5);
    // Waves along the side: a ring alone would not tell.
    const double r = 10 + std::sin(9 * a), z = 15 - r;
    text +=
        fmt::format("G1 X{:.6f} Y{:.6f} Z{:.6f} I{:.9f} J{:.9f} K{:.9f} E0.1 F600\n", r * std::cos(a),
                    r * std::sin(a), z, (square ? s : -s) * std::cos(a), (square ? s : -s) * std::sin(a), s);
  }
  GcodeOptions options;
  return reading_quality(parse_gcode(text, "p.gcode", options), Vec3(10e-3, 0, 5e-3));
}

TEST(ReadingQuality, AToolThatStandsOnItsLayerLooksLikeAPrint) {
  const ReadingQuality right = ring(true), wrong = ring(false);
  EXPECT_EQ(right.moves, 100);
  EXPECT_LT(to_deg(right.out_of_layer), 3) << "the chords of a cone";
  EXPECT_GT(to_deg(wrong.out_of_layer), 20);
  EXPECT_LT(to_mm(right.longest_step), 1.5);
}

TEST(ReadingQuality, OnlyLeaningMovesCountWhereThereAreAny) {
  const std::string upright = "M83\nG0 X0 Y0 Z0\nG1 X1 E1 F60\nG1 X2 Z1 E1\n";
  EXPECT_EQ(reading_quality(parse_gcode(upright, "p", {}), Vec3::Zero()).moves, 2);
  const std::string leaning = upright + "G1 X3 I0.6 J0 K0.8 E1\n";
  const ReadingQuality q = reading_quality(parse_gcode(leaning, "p", {}), Vec3::Zero());
  EXPECT_EQ(q.moves, 1);
  EXPECT_NEAR(to_deg(q.out_of_layer), to_deg(std::asin(0.6)), 1e-9);
  EXPECT_NEAR(q.longest_step, std::sqrt(2) * 1e-3, 1e-12);
}

// Nine beads of 0.1 mm of filament on 1 mm, then three of the same on a quarter of it.
TEST(ReadingQuality, BeadsThatDifferTell) {
  std::string text = "M83\nG0 X0 Y0 Z0\n";
  for (int i = 1; i <= 9; ++i) text += fmt::format("G1 X{} E0.1 F60\n", i);
  const ReadingQuality even = reading_quality(parse_gcode(text, "p", {}), Vec3::Zero());
  EXPECT_NEAR(even.bead_spread, 1, 1e-9);
  EXPECT_NEAR(even.filament_share, 0.1, 1e-12);
  for (int i = 0; i < 3; ++i) text += fmt::format("G1 X{} E0.1\n", 9.25 + 0.25 * i);
  EXPECT_NEAR(reading_quality(parse_gcode(text, "p", {}), Vec3::Zero()).bead_spread, 4, 1e-9);
  EXPECT_EQ(reading_quality(parse_gcode("G0 X1\n", "p", {}), Vec3::Zero()).bead_spread, 1);
}

// Upright, every reading has the same beads.
TEST(ReadingQuality, BeadsOfALeaningToolAloneTellWhereThereAreAny) {
  std::string text = "M83\nG0 X0 Y0 Z0\n";
  for (int i = 1; i <= 9; ++i) text += fmt::format("G1 X{} E{} F60\n", i, 0.1 * i);
  text += "G1 X10 I0.6 J0 K0.8 E0.1\nG1 X11 E0.1\n";
  EXPECT_NEAR(reading_quality(parse_gcode(text, "p", {}), Vec3::Zero()).bead_spread, 1, 1e-9);
}

}  // namespace
}  // namespace understudy::toolpath
