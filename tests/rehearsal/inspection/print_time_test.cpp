#include "rehearsal/inspection/print_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"
#include "toolpath/inspection/program_summary.h"

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;
using testing::Field;

const std::string kBox = UNDERSTUDY_SOURCE_DIR "/scenarios/planar/box.gcode";

PrintTime time_on(const std::string& machine, const std::string& program) {
  RehearsalRequest request;
  request.program = program;
  request.machine = machine;
  return print_time(request, toolpath::slicer_facts(read_file(program)));
}

// Sliced with this machine's limits: docs/print-time.md.
TEST(PrintTime, IsThePlannersBesideTheSlicers) {
  const PrintTime time = time_on("five-axis", kBox);
  ASSERT_TRUE(time.planned && time.slicers);
  EXPECT_EQ(*time.slicers, 16 * 60 + 11);
  EXPECT_NEAR(*time.planned, *time.slicers, 0.03 * *time.slicers);
  EXPECT_TRUE(time.limits.empty());
}

TEST(PrintTime, TellsWhichLimitsTheSlicerCountedWith) {
  const auto others =
      other_limits(machine::load_machine("five-axis"), {{"machine_max_acceleration_extruding", "1500,1250"},
                                                        {"travel_speed", "100"},
                                                        {"machine_max_jerk_x", "10,10"},
                                                        {"machine_max_feedrate_z", "30,12"}});
  EXPECT_THAT(others,
              ElementsAre(Field(&OtherLimit::name, "acceleration"), Field(&OtherLimit::name, "jump of x")));
  EXPECT_EQ(others[0].slicer, 1500);
  EXPECT_EQ(others[0].here, 1000);
}

TEST(PrintTime, WhatCannotBeReachedHasNone) {
  const TemporaryFolder folder;
  const std::string program = (folder / "far.gcode").string();
  write_file(program, "; estimated printing time (normal mode) = 5s\nG1 X9000 F600\n");
  const PrintTime time = time_on("arm", program);
  EXPECT_FALSE(time.planned.has_value());
  EXPECT_EQ(time.slicers, 5);
}

}  // namespace
}  // namespace understudy::rehearsal
