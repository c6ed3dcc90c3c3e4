#include "toolpath/inspection/feature_types.h"

#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

TEST(FeatureTypes, AreReadAsEachSlicerWritesThem) {
  const FeatureTypes types(
      "G28\n"                                               // 1
      ";TYPE:Skirt/Brim\n"                                  // PrusaSlicer
      "G1 X1 E1\r\n"                                        // 3
      ";TYPE:WALL-OUTER\r\n"                                // Cura
      "G1 X2 E1 ; TYPE:none, for it is not at the start\n"  // 5
      "; FEATURE: Outer wall\n"                             // BambuStudio
      "; feature solid layer\n"                             // Simplify3D
      "; 'Perimeter Path', 0.6 [feed mm/s]\n"               // KISSlicer
      "G1 X3 E1\n");
  EXPECT_EQ(types.changes().front(), (std::pair<int, std::string>(2, "Skirt/Brim")));
  EXPECT_EQ(types.at(0), "");
  EXPECT_EQ(types.at(1), "");
  EXPECT_EQ(types.at(2), "Skirt/Brim");
  EXPECT_EQ(types.at(3), "Skirt/Brim");
  EXPECT_EQ(types.at(5), "WALL-OUTER");
  EXPECT_EQ(types.at(6), "Outer wall");
  EXPECT_EQ(types.at(7), "solid layer");
  EXPECT_EQ(types.at(9), "Perimeter");
  EXPECT_EQ(types.at(1000), "Perimeter");
  EXPECT_EQ(FeatureTypes("G1 X1 ; a comment\n; type\n;TYPE:\n").at(3), "");
}

TEST(FeatureTypes, WhatIsThrownAwayLiesBesideThePart) {
  for (const char* type :
       {"Skirt/Brim", "SKIRT", "Brim", "Custom", "Wipe tower", "Prime tower", "PRIME-TOWER", "skirt"})
    EXPECT_TRUE(is_beside_part(type)) << type;
  for (const char* type :
       {"", "External perimeter", "WALL-OUTER", "Support material", "Bridge infill", "Bottom surface"})
    EXPECT_FALSE(is_beside_part(type)) << type;
}

TEST(FeatureTypes, LengthsAreThoseOfPrintedPath) {
  const std::string text =
      "G21\nG90\nM83\nG1 X10 E1 F600\n;TYPE:Perimeter\nG1 X20 E1\nG1 X50\nG1 X53 Y4 E1\n;TYPE:Skirt\nG1 X53 "
      "Y14 E1\n";
  const auto lengths = feature_lengths(parse_gcode(text, "p.gcode", {}), FeatureTypes(text), Vec3::Zero());
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths.at("Perimeter"), 15e-3, 1e-12);
  EXPECT_NEAR(lengths.at("Skirt"), 10e-3, 1e-12);
}

}  // namespace
}  // namespace understudy::toolpath
