#include "drivers/hal/hal_row.h"

#include <gtest/gtest.h>

namespace understudy::drivers {
namespace {

HalSettings slide_turn_and_filament() {
  HalSettings settings;
  settings.axes.resize(3);
  settings.axes[1].angle = true;
  settings.machine_axes = 2;
  return settings;
}

TEST(HalRow, IsALineOfMillimetresDegreesAndCelsius) {
  HalRow row;
  row.position = {0.1234567891234, 0.5235987755983};  // [m], 30 degrees
  row.filament = 2e-3;
  row.number = 7;
  row.reset = true;
  row.outputs = {483.15, 0.5};
  std::string text = "before\n";
  append(row, slide_turn_and_filament(), text);
  EXPECT_EQ(text, "before\n123.456789123 30.000000000 2.000000000 7 1 210.000 0.5000\n");
}

TEST(HalRow, AHeaterThatIsOffIsZero) {
  std::string text;
  append(HalRow(), slide_turn_and_filament(), text);
  EXPECT_EQ(text, "0.000000000 0.000000000 0.000000000 0 0 0.000 0.0000\n");
}

TEST(HalRow, ASampleIsReadInSi) {
  HalSample s;
  ASSERT_TRUE(parse("123.456789 -90.000000 1.500000 42 3 1 1 1 0 0 1 ", slide_turn_and_filament(), s));
  EXPECT_DOUBLE_EQ(s.position[0], 0.123456789);
  EXPECT_NEAR(s.position[1], -1.5707963267949, 1e-12);
  EXPECT_DOUBLE_EQ(s.filament, 1.5e-3);
  EXPECT_EQ(s.number, 42);
  EXPECT_EQ(s.underruns, 3);
  EXPECT_TRUE(s.on && s.drives && s.following && s.stop_released);
  EXPECT_FALSE(s.starved || s.limit);
}

TEST(HalRow, WhatEncodersBehindThePlayReadFollowsTheState) {
  HalSettings settings = slide_turn_and_filament();
  settings.load_encoders = true;
  HalSample s;
  const std::string state = "123.456789 -90.000000 1.500000 42 3 1 1 1 0 0 1 ";
  ASSERT_TRUE(parse(state + "123.469289 -89.000000", settings, s));
  EXPECT_DOUBLE_EQ(s.position[0], 0.123456789);
  EXPECT_DOUBLE_EQ(s.load[0], 0.123469289);
  EXPECT_NEAR(s.load[1], -1.5533430342750, 1e-12);
  EXPECT_FALSE(parse(state + "123.469289", settings, s)) << "of one axis it is not known";
}

TEST(HalRow, WhatIsNoSampleIsRefused) {
  HalSample s;
  for (const char* line :
       {"", "overrun", "1 2 3", "1 2 3 4 5 1 1 1 0 0", "1 2 3 4 5 1 1 1 0 0 2", "1 2 x 4 5 1 1 1 0 0 1"})
    EXPECT_FALSE(parse(line, slide_turn_and_filament(), s)) << line;
}

}  // namespace
}  // namespace understudy::drivers
