#include "rehearsal/inspection/start_temperature.h"

#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

TEST(StartTemperature, IsTheMacrosParameterOfTheNozzle) {
  EXPECT_EQ(start_temperature("M104 S0\nSTART_PRINT EXTRUDER_TEMP=220 BED_TEMP=60\n", {}), 220);
  EXPECT_EQ(start_temperature("print_start bed=110 extruder=235 chamber=40\n", {}), 235);
  EXPECT_EQ(start_temperature("PRINT_START BED=110 HOTEND=245.5\n", {{"temperature", "200"}}), 245.5);
}

TEST(StartTemperature, OrTheSlicersComment) {
  EXPECT_EQ(start_temperature("PRINT_START BED=110\n", {{"temperature", "235"}}), 235);
  EXPECT_EQ(
      start_temperature("PRINT_START\n", {{"first_layer_temperature", "215,0"}, {"temperature", "200"}}),
      215);
}

TEST(StartTemperature, OrNone) {
  EXPECT_FALSE(start_temperature("PRINT_START BED=110 EXTRUDER=0\nG1 X1 ; EXTRUDER=220\n", {}));
  EXPECT_FALSE(
      start_temperature("EXCLUDE_OBJECT_DEFINE NAME=TEMPLATE CENTER=150,150\n", {{"temperature", "0"}}));
}

}  // namespace
}  // namespace understudy::rehearsal
