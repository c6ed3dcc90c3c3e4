#include "toolpath/duration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& gcode, double limit) {
  try {
    check_duration(parse_gcode(gcode, "s.gcode", {}), Vec3(0, 0, 0.02), limit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Duration, MovesAtTheirFeedsAndDwellsAddUp) {
  const std::string program = "G0 X0 Y0 Z0\nG1 X10 F60\nG4 S5\nG1 X0 E1 F120\n";  // 10 s, 5 s, 5 s
  EXPECT_EQ(refusal(program, 20.001), "");
  EXPECT_THAT(refusal(program, 19.999),
              AllOf(HasSubstr("s.gcode:4"), HasSubstr("20 s"), HasSubstr("--max-time")));
  EXPECT_THAT(refusal(program, 14), HasSubstr("s.gcode:3"));
}

TEST(Duration, AbsurdFeedsAreRefused) {
  EXPECT_THAT(refusal("G0 X0 Y0 Z0\nG1 X30 F1e-30\n", 86400), HasSubstr("s.gcode:2"));
  EXPECT_THAT(refusal("G0 X0 Y0 Z0\nG1 X30 F1e-300\n", 86400), HasSubstr("s.gcode:2"));
  EXPECT_THAT(refusal("G0 X0 Y0 Z0\nG93\nG1 X30 F1e-9\n", 86400), HasSubstr("s.gcode:3"));
  EXPECT_THAT(refusal("G0 X0 Y0 Z0\nG1 E1 F1e-9\n", 86400), HasSubstr("s.gcode:2")) << "filament alone";
  EXPECT_THAT(refusal("G0 X0 Y0 Z0\nG4 S86400\nG4 S1\n", 86400), HasSubstr("s.gcode:3"));
}

TEST(Duration, TheFirstMoveBeginsWhereTheToolStands) {
  EXPECT_THAT(refusal("G1 X0 Y0 Z0 F1e-30\n", 86400), HasSubstr("s.gcode:1"));
  EXPECT_EQ(refusal("G1 X0 Y0 Z0 F60\n", 20.001), "");  // 20 mm at 1 mm/s
  EXPECT_NE(refusal("G1 X0 Y0 Z0 F60\n", 19.999), "");
}

}  // namespace
}  // namespace understudy::toolpath
