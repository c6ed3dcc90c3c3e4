#include "report/recorded/trace_table.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "report/trace/trace_csv.h"
#include "tests/report/sample_record.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;

class TraceTableTest : public testing::Test {
 protected:
  TraceTable read(const std::string& text) const {
    write_file(folder_ / "trace.csv", text);
    return read_trace_table(folder_ / "trace.csv");
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

TEST_F(TraceTableTest, IsReadAsItWasWritten) {
  const rehearsal::Record record = sample_go();
  const TraceTable table = read(trace_csv(record));
  ASSERT_EQ(table.columns.size(), table.names.size());
  EXPECT_EQ(table.names.front(), "time_s");
  ASSERT_EQ(table.rows(), record.trace.size());
  EXPECT_NEAR(table.columns.front().back(), record.trace.back().time, 1e-6);
}

TEST_F(TraceTableTest, AGapMayBeEmptyAndNothingElse) {
  const TraceTable table = read("time_s,gap_mm\n0,0.1\n\n1,\n");
  EXPECT_THAT(table.columns[0], ElementsAre(0, 1));
  EXPECT_EQ(table.columns[1][0], 0.1);
  EXPECT_TRUE(std::isnan(table.columns[1][1]));
  EXPECT_THAT(table.lines, ElementsAre(2, 4));
  EXPECT_THAT(refusal("time_s,path_mm\n0,\n"), EndsWith("trace.csv:2:3: path_mm is '', not a finite number"));
}

TEST_F(TraceTableTest, WhatIsNoTraceIsRefused) {
  EXPECT_THAT(refusal("x_mm,y_mm\n1,2\n"),
              EndsWith("trace.csv:1: this is no trace of a rehearsal: its first column is x_mm, not time_s"));
  EXPECT_THAT(refusal("time_s,line\n0,1\n0"), EndsWith("no end of line at its end: it was cut off"));
  EXPECT_THAT(refusal("time_s,line\n0,1\n1\n"),
              EndsWith("trace.csv:3: 1 cells, where the header names 2: the trace is damaged"));
  EXPECT_THAT(refusal("time_s,line\n1,1\n0,1\n"), EndsWith("trace.csv:3: time_s goes back from 1 to 0"));
}

}  // namespace
}  // namespace understudy::report
