#include "report/page/live_record.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

rehearsal::TracePoint at(double time) {
  static const rehearsal::TracePoint first = sample_go().trace.front();
  rehearsal::TracePoint point = first;
  point.time = time;
  return point;
}

nlohmann::json read(const LiveRecord& live) { return nlohmann::json::parse(live.json()); }

rehearsal::Record described() {
  rehearsal::Record record = sample_go();
  record.trace.clear();
  record.gap_beliefs.clear();
  record.replay = {};
  record.scene = {};
  return record;
}

TEST(LiveRecord, SaysThatItReadsBeforeTheRunBegins) {
  const LiveRecord live;
  const auto report = read(live);
  EXPECT_EQ(report.at("live").at("what"), "reading");
  EXPECT_EQ(report.at("live").at("share"), 0);
  EXPECT_FALSE(report.contains("trace"));
}

TEST(LiveRecord, GrowsWithTheRun) {
  LiveRecord live;
  live.begins(described());
  EXPECT_EQ(read(live).at("title"), described().title);
  live.moved(at(0.5));
  live.moved(at(1.5));
  live.progress(0.25, "printing");
  const auto report = read(live);
  EXPECT_EQ(report.at("live").dump(), R"({"share":0.25,"what":"printing"})");
  EXPECT_EQ(report.at("trace").at("columns").at("time_s"), nlohmann::json::parse("[0.5,1.5]"));
  EXPECT_EQ(nlohmann::json::parse(live.progress_json()), report.at("live"));
}

TEST(LiveRecord, OfAMotionAloneNobodyKnowsTheErrors) {
  LiveRecord live;
  live.begins_motion(described(), "the rehearsal comes");
  live.moved(at(0.5));
  live.progress(0, "receiving");
  auto report = read(live);
  EXPECT_EQ(report.at("live").dump(), R"({"note":"the rehearsal comes","share":0.0,"what":"receiving"})");
  EXPECT_TRUE(report.at("trace").at("columns").contains("x_mm"));
  for (const char* unknown : {"gap_mm", "tip_error_um", "orientation_error_mrad"})
    EXPECT_FALSE(report.at("trace").at("columns").contains(unknown)) << unknown;
  live.begins(described());  // of what was received
  report = read(live);
  EXPECT_FALSE(report.contains("trace")) << "its time begins anew";
  EXPECT_FALSE(report.at("live").contains("note"));
  live.moved(at(0.1));
  EXPECT_TRUE(read(live).at("trace").at("columns").contains("gap_mm"));
}

TEST(LiveRecord, KeepsAtMostItsCapacityOverTheWholeRun) {
  LiveRecord live(8);
  live.begins(described());
  for (int i = 0; i < 1000; ++i) live.moved(at(i));
  const auto report = read(live);
  const auto& times = report.at("trace").at("columns").at("time_s");
  ASSERT_LE(times.size(), 8U);
  ASSERT_GE(times.size(), 4U);
  EXPECT_EQ(times.front(), 0);
  EXPECT_GE(times.back().get<double>(), 1000 - 2 * 128);  // the last but one or two of equal steps
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_EQ(times[i].get<double>() - times[i - 1].get<double>(), times[1].get<double>()) << i;
}

TEST(LiveRecord, ThePageMayAskItsServerAndNothingElse) {
  LiveRecord live;
  rehearsal::Record record = described();
  record.title = "</script><b>.gcode";
  live.begins(record);
  const std::string page = live.page();
  EXPECT_NE(page.find("connect-src 'self'"), std::string::npos);
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  EXPECT_NE(page.find("running: "), std::string::npos);
}

}  // namespace
}  // namespace understudy::report
