#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "report/trace/trace_csv.h"
#include "report/trace/trace_values.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using rehearsal::Record;
using rehearsal::TracePoint;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

Record one_point() {
  Record record;
  record.axes = {{"l1_mm", 0.17, 0.24}, {"j2_deg", {}, {}}};
  TracePoint point;
  point.time = 1.25;
  point.line = 7;
  point.extruding = true;
  point.X_WT = make_pose(Quat(Eigen::AngleAxisd(from_deg(60), Vec3::UnitX())), Vec3(1e-3, -2e-3, 30e-3));
  point.X_WT_programmed = make_pose(Quat::Identity(), Vec3(1.1e-3, -2e-3, 30e-3));
  point.tip_error = 100e-6;
  point.orientation_error = from_deg(60);
  point.gap = 0.13e-3;
  point.path = 12e-3;
  point.axes[0] = 0.2;
  point.axes[1] = from_deg(-45);
  record.trace = {point};
  return record;
}

TEST(TraceCsv, NamesItsColumnsWithUnitsAndConvertsToThem) {
  const std::vector<std::string> lines = split(trace_csv(one_point()), '\n');
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(
      lines[0],
      "time_s,line,extruding,x_mm,y_mm,z_mm,qw,qx,qy,qz,programmed_x_mm,programmed_y_mm,programmed_z_mm,"
      "programmed_qw,programmed_qx,programmed_qy,programmed_qz,tip_error_um,orientation_error_mrad,gap_mm,"
      "path_mm,l1_mm,j2_deg");
  // 60 degrees about x: (cos 30, sin 30, 0, 0); 60 degrees are 1047.1976 mrad.
  EXPECT_EQ(lines[1],
            "1.250000,7,1,1.000000,-2.000000,30.000000,0.866025404,0.500000000,0.000000000,0.000000000,"
            "1.100000,-2.000000,30.000000,1.000000000,0.000000000,0.000000000,0.000000000,100.000,1047.1976,"
            "0.130000,12.000000,200.000000,-45.0000000");
}

TEST(TraceCsv, PiecesMakeTheWhole) {
  Record record = one_point();
  record.trace.resize(2000, record.trace[0]);
  std::size_t pieces = 0, largest = 0;
  std::string text;
  make_trace_csv(record, [&](std::string_view piece) {
    ++pieces;
    largest = std::max(largest, piece.size());
    text += piece;
  });
  EXPECT_EQ(text, trace_csv(record));
  const std::vector<std::string> lines = split(text, '\n');
  ASSERT_EQ(lines.size(), 2001u);
  for (const std::string& line : std::span(lines).subspan(1))
    EXPECT_EQ(line, split(trace_csv(one_point()), '\n')[1]);
  EXPECT_GT(pieces, 3u);
  EXPECT_LT(largest, 101'000u);
}

TEST(TraceCsv, NothingBelowTheTipIsAnEmptyCell) {
  Record record = one_point();
  record.trace[0].gap = std::numeric_limits<double>::infinity();
  const std::vector<std::string> cells = split(split(trace_csv(record), '\n')[1], ',');
  EXPECT_EQ(cells[19], "");
  EXPECT_EQ(cells[20], "12.000000");
}

TEST(TraceCsv, OtherNumbersThatAreNotFiniteAreOurOwnMistake) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Record gap = one_point(), error = one_point(), below = one_point();
  gap.trace[0].gap = nan;
  error.trace[0].tip_error = nan;
  below.trace[0].gap = -std::numeric_limits<double>::infinity();
  EXPECT_THROW(trace_csv(gap), std::logic_error);
  EXPECT_THROW(trace_csv(error), std::logic_error);
  EXPECT_THROW(trace_csv(below), std::logic_error);
}

TEST(TraceCsv, HasNoNegativeZero) {
  Record record = one_point();
  record.trace[0].gap = -1e-13;
  EXPECT_EQ(split(split(trace_csv(record), '\n')[1], ',')[19], "0.000000");
}

TEST(TraceCsv, AnAxisWithoutAUnitIsOurOwnMistake) {
  Record record = one_point();
  record.axes[0].name = "l1";
  EXPECT_THROW(trace_csv(record), std::logic_error);
}

TEST(ThinOut, KeepsEndsExtremesAndEverySwitchOfExtrusion) {
  const std::vector<TracePoint> full = sample_no_go().trace;
  std::vector<TracePoint> trace = full;
  trace[4321].gap = -1e-3;  // one sample wide
  trace[5555].tip_error = 5e-3;
  trace[6003].gap = 3e-3;
  const std::vector<std::size_t> kept = thin_out(trace, 400);
  EXPECT_LE(kept.size(), 410u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(std::set<std::size_t>(kept.begin(), kept.end()).size(), kept.size());
  for (const std::size_t wanted : {std::size_t{0}, std::size_t{4321}, std::size_t{5555}, std::size_t{6003},
                                   std::size_t{2999}, std::size_t{3000}, trace.size() - 1})
    EXPECT_THAT(kept, testing::Contains(wanted));
  EXPECT_FALSE(trace[2999].extruding);
  EXPECT_TRUE(trace[3000].extruding);
}

// A bucket that begins with nothing below the tip still shows its largest finite gap.
TEST(ThinOut, KeepsTheLargestGapBesideInfiniteOnes) {
  std::vector<TracePoint> trace(1000);
  for (std::size_t i = 0; i < trace.size(); ++i)
    trace[i].gap = i % 5 == 0 ? std::numeric_limits<double>::infinity() : 1e-4;
  trace[503].gap = 4e-4;
  EXPECT_THAT(thin_out(trace, 40), testing::Contains(503u));
}

// Of samples that are equal but for rounding the first is kept, whichever the rounding favours.
TEST(ThinOut, DoesNotHangOnTheLastBit) {
  std::vector<TracePoint> trace(1000), other(1000);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace[i].gap = other[i].gap = 1.3e-4;
    trace[i].tip_error = other[i].tip_error = 5e-5;
  }
  for (std::size_t i = 3; i < trace.size(); i += 7) {
    other[i].gap = std::nextafter(1.3e-4, i % 2 ? 0.0 : 1.0);
    other[i].tip_error = std::nextafter(5e-5, 1.0);
  }
  EXPECT_EQ(thin_out(trace, 40), thin_out(other, 40));
}

TEST(ThinOut, LeavesAShortTraceAlone) {
  EXPECT_THAT(thin_out(std::vector<TracePoint>(3), 100), testing::ElementsAre(0u, 1u, 2u));
  EXPECT_TRUE(thin_out({}, 100).empty());
}

}  // namespace
}  // namespace understudy::report
