#include "report/recorded/recorded_trace.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHeader =
    "time_s,line,extruding,x_mm,tip_error_um,orientation_error_mrad,gap_mm,path_mm,l1_mm\n";

class RecordedTrace : public testing::Test {
 protected:
  std::vector<rehearsal::TracePoint> read(const std::string& text) const {
    write_file(folder_ / "trace.csv", text);
    return read_recorded_trace(folder_ / "trace.csv");
  }
  std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
};

TEST_F(RecordedTrace, ColumnsAreFoundByNameAndReadInTheirUnits) {
  const auto trace = read(std::string(kHeader) + "0.5,7,1,3,120.5,2.5,0.13,1.5,190\n0.6,8,0,3,0,0,,2,190\n");
  ASSERT_EQ(trace.size(), 2u);
  EXPECT_DOUBLE_EQ(trace[0].time, 0.5);
  EXPECT_EQ(trace[0].line, 7);
  EXPECT_TRUE(trace[0].extruding);
  EXPECT_DOUBLE_EQ(trace[0].tip_error, 120.5e-6);
  EXPECT_DOUBLE_EQ(trace[0].orientation_error, 2.5e-3);
  EXPECT_DOUBLE_EQ(trace[0].gap, 0.13e-3);
  EXPECT_DOUBLE_EQ(trace[0].path, 1.5e-3);
  EXPECT_TRUE(std::isinf(trace[1].gap)) << "nothing lies below";
  EXPECT_FALSE(trace[1].extruding);
}

TEST_F(RecordedTrace, WhatIsDamagedIsRefusedWithItsPlace) {
  const std::string header = kHeader, row = "0.5,7,1,3,120,2,0.1,1,190\n";
  EXPECT_THAT(refusal(""), HasSubstr("cut off"));
  EXPECT_THAT(refusal("\n"), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("time_s,line\n0,1\n"), HasSubstr("trace.csv:1: column 'extruding' is missing"));
  EXPECT_THAT(refusal(header + row + "0.6,8,1,3,12"), HasSubstr("cut off"));
  EXPECT_THAT(refusal(header + row + "0.6,8,1,3\n"),
              HasSubstr("trace.csv:3: 4 cells, where the header names 9"));
  EXPECT_THAT(refusal(header + "0.5,7,1,3,nan,2,0.1,1,190\n"),
              HasSubstr("trace.csv:2:11: tip_error_um is 'nan', not a finite number"));
  EXPECT_THAT(refusal(header + "0.5,7,1,3,,2,0.1,1,190\n"), HasSubstr("tip_error_um is ''"));
  EXPECT_THAT(refusal(header + "0.5,-1,1,3,1,2,0.1,1,190\n"), HasSubstr("line is -1"));
  EXPECT_THAT(refusal(header + row + "0.4,8,1,3,1,2,0.1,1,190\n"),
              HasSubstr("time_s goes back from 0.5 to 0.4"));
}

}  // namespace
}  // namespace understudy::report
