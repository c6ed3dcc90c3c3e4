#include "toolpath/inspection/slicer_filament.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

double told(const char* text) { return told_filament(text).value_or(-1); }

TEST(SlicerFilament, IsReadAsSlicersWriteIt) {
  EXPECT_NEAR(told("; filament used [mm] = 264.59\n; filament used [cm3] = 0.64\n"), 0.26459, 1e-9);
  EXPECT_NEAR(told("G1 X1\n;Filament used: 1.67714m\r\n"), 1.67714, 1e-9) << "Cura";
  EXPECT_NEAR(told("; filament used = 332.4mm (2.3cm3)\n"), 0.3324, 1e-9) << "Slic3r";
  EXPECT_NEAR(told("; total filament length [mm] : 1503.61\n"), 1.50361, 1e-9) << "BambuStudio";
  EXPECT_NEAR(told("; --- filament used: 225.03 mm ---\n"), 0.22503, 1e-9) << "Kiri:Moto";
  EXPECT_NEAR(told(";   Filament length: 1234.5 mm (1.23 m)\n"), 1.2345, 1e-9) << "Simplify3D";
}

TEST(SlicerFilament, OfSeveralExtrudersIsASum) {
  EXPECT_NEAR(told("; filament used [mm] = 10.5, 20.25\n"), 0.03075, 1e-9);
  EXPECT_NEAR(told(";Filament used: 0.5m, 0.25m\n"), 0.75, 1e-9);
  EXPECT_NEAR(told(";Material#1 Used: 400.5\n;Material#2 Used: 0.5\n;Material#1 Cost: 9\n"), 0.401, 1e-9);
  EXPECT_NEAR(told("; Filament used per extruder:\n;    Ext #1 =  306.10 mm  (0.736 cm^3)\n"), 0.3061, 1e-9);
}

TEST(SlicerFilament, OtherCommentsTellNone) {
  for (const char* text :
       {"", "G1 E5 ; filament used\n", "; filament used [g] = 5\n", "; filament used: much\n",
        "; total filament used [g] = 0.67\n", "; filament used = -1\n", ";Filament used: 0m\n"})
    EXPECT_FALSE(told_filament(text).has_value()) << text;
}

}  // namespace
}  // namespace understudy::toolpath
