#include "toolpath/inspection/floating_share.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

/// A square of 10 mm, printed at a height [mm].
std::string square(double z, double x = 0) {
  return fmt::format("G0 X{0} Y0 Z{1}\nG1 X{2} E1 F600\nG1 Y10 E1\nG1 X{0} E1\nG1 Y0 E1\n", x, z, x + 10);
}

double share(const std::string& squares) {
  return floating_share(parse_gcode("M83\n" + squares, "p", {}), Vec3::Zero());
}

TEST(FloatingShare, LayersLieOnEachOtherAndOnTheGround) {
  std::string layers;
  for (int i = 1; i <= 10; ++i) layers += square(0.2 * i);
  EXPECT_EQ(share(layers), 0);
  EXPECT_EQ(share(layers + square(0.2, 30)), 0) << "beside them, on the ground";
}

TEST(FloatingShare, WhatHasNothingBelowOrBesideItFloats) {
  std::string layers;
  for (int i = 1; i <= 9; ++i) layers += square(0.2 * i);
  EXPECT_NEAR(share(layers + square(6)), 0.1, 0.005) << "one layer of ten, high above the others";
  EXPECT_NEAR(share(layers + square(6) + square(6.2)), 1 / 11.0, 0.005) << "the next lies on it";
}

TEST(FloatingShare, ALineHoldsNothingOfItself) {
  // To and fro, 0.2 mm apart: what was printed just now is near, and holds nothing. A point
  // each half millimetre of 44.01 mm, 89 in all: 9 of them from 40 mm on.
  const std::string layers = square(0.2);
  EXPECT_NEAR(share(layers + "G0 X5 Y5 Z9\nG1 X7 E1\nG1 X5 Y5.2 E1\n"), 9.0 / 89, 1e-12);
}

TEST(FloatingShare, NothingPrintedIsNothingInTheAir) { EXPECT_EQ(share("G0 X1 Z9\n"), 0); }

}  // namespace
}  // namespace understudy::toolpath
