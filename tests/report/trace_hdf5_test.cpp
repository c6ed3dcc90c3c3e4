#include "report/trace_hdf5.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "report/trace_csv.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    read_trace_csv(text, "trace.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TraceHdf5, TheTableIsReadAsItWasWritten) {
  const rehearsal::Record record = sample_go();
  const TraceTable table = read_trace_csv(trace_csv(record), "trace.csv");
  ASSERT_EQ(table.columns.size(), table.names.size());
  EXPECT_EQ(table.names.front(), "time_s");
  ASSERT_EQ(table.columns.front().size(), record.trace.size());
  EXPECT_NEAR(table.columns.front().back(), record.trace.back().time, 1e-6);
}

TEST(TraceHdf5, AnEmptyCellIsNoNumber) {
  const TraceTable table = read_trace_csv("time_s,gap_mm\n0,0.1\n1,\n", "trace.csv");
  EXPECT_THAT(table.columns[0], ElementsAre(0, 1));
  EXPECT_EQ(table.columns[1][0], 0.1);
  EXPECT_TRUE(std::isnan(table.columns[1][1]));
}

TEST(TraceHdf5, RefusesWhatIsNoTrace) {
  EXPECT_EQ(refusal(""), "trace.csv: the table is empty");
  EXPECT_EQ(refusal("x_mm,y_mm\n1,2\n"),
            "trace.csv:1: not a trace of a rehearsal: its first column is x_mm, not time_s");
  EXPECT_EQ(refusal("time_s,line\n"), "trace.csv: a header without rows");
  EXPECT_EQ(refusal("time_s,line\n0,1\n1\n"), "trace.csv:3: 1 cells; the header has 2");
  EXPECT_THAT(refusal("time_s,line\n0,one\n"), HasSubstr("trace.csv:2:3: line is 'one'"));
}

// What stands in the file is read by another implementation: tests/python/trace_file_test.py.
TEST(TraceHdf5, EqualTablesGiveEqualBytesOfTheFormat) {
  const TraceTable table = read_trace_csv(trace_csv(sample_go()), "trace.csv");
  const std::string bytes = trace_hdf5(table, {{"version", "1"}});
  EXPECT_EQ(bytes.substr(0, 8), "\x89HDF\r\n\x1a\n");  // HDF5 File Format Specification, II.A
  EXPECT_EQ(bytes, trace_hdf5(table, {{"version", "1"}}));
  EXPECT_NE(bytes, trace_hdf5(table, {{"version", "2"}}));
}

}  // namespace
}  // namespace understudy::report
