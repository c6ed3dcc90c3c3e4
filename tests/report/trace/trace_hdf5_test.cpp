#include "report/trace/trace_hdf5.h"

#include <gtest/gtest.h>

namespace understudy::report {
namespace {

// What stands in the file is read by another implementation: tests/python/trace_file_test.py.
TEST(TraceHdf5, EqualTablesGiveEqualBytesOfTheFormat) {
  const TraceTable table{{"time_s", "line"}, {{0, 0.5}, {1, 2}}, 1, {2, 3}};
  const std::string bytes = trace_hdf5(table, {{"version", "1"}});
  EXPECT_EQ(bytes.substr(0, 8), "\x89HDF\r\n\x1a\n");  // HDF5 File Format Specification, II.A
  EXPECT_EQ(bytes, trace_hdf5(table, {{"version", "1"}}));
  EXPECT_NE(bytes, trace_hdf5(table, {{"version", "2"}}));
}

}  // namespace
}  // namespace understudy::report
