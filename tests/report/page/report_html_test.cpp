#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/page/page_parts.h"
#include "report/page/report_data.h"
#include "report/page/report_html.h"
#include "report/summary_json.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using rehearsal::FrameRecord;
using rehearsal::Record;
using rehearsal::TracePoint;
using Json = nlohmann::json;
using testing::HasSubstr;

std::string data_block(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"record\">";
  const std::size_t begin = page.find(open) + open.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

std::string page_of(const Record& record, const std::vector<Illustration>& pictures) {
  nlohmann::ordered_json data = report_data(record);
  data["pictures"] = pictures_value(pictures);
  return report_html(record, data);
}

Json data_of(const Record& record, const std::vector<Illustration>& pictures = sample_pictures()) {
  return Json::parse(data_block(page_of(record, pictures)));
}

TEST(ReportHtml, NeedsNothingFromOutside) {
  const std::string page = page_of(sample_go(), sample_pictures());
  // Its script can ask the server of a run that goes on; here the policy forbids that.
  for (const char* outside : {"src=\"http", "<link", "@import", "url(http", "{{title}}", "{{script}}"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);  // and the browser holds it to that
  EXPECT_EQ(page.find("connect-src"), std::string::npos);
}

TEST(ReportHtml, CarriesTheNoticesOfWhatIsBundled) {
  const std::string page = page_of(sample_go(), sample_pictures());
  const std::string notices = page.substr(page.find("<!-- "), page.find(" -->") - page.find("<!-- "));
  for (const auto& [name, version] : page_packages()) EXPECT_THAT(notices, HasSubstr(name + " " + version));
  if (page_packages().empty()) return;  // the plain page
  for (const char* notice :
       {"three.js authors", "Leon Sorokin", "Arjun Barrett", "The above copyright notice"})
    EXPECT_THAT(notices, HasSubstr(notice));
}

TEST(ReportHtml, SaysTheVerdictWithoutAScriptToo) {
  const std::string page = page_of(sample_stopped_by_constraints(), {});
  const std::string noscript = page.substr(page.find("<noscript>"), 400);
  EXPECT_THAT(noscript, HasSubstr("NO-GO: curved-line.gcode on hexapod"));
  EXPECT_THAT(noscript, HasSubstr("Strut 3 is 241.7 mm, longer than 240.0 mm"));
}

TEST(ReportHtml, DataCannotBecomeMarkup) {
  Record record = sample_no_go();
  const std::string evil =
      "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)> & \"{{style}}\"";
  record.title = record.findings[0].message = record.frames[3].look.why = evil;
  auto pictures = sample_pictures();
  pictures[0].caption = evil;
  const std::string page = page_of(record, pictures);
  for (const char* markup : {"<script>alert", "<img src=x"})
    EXPECT_EQ(page.find(markup), std::string::npos) << markup;
  const Json data = data_of(record, pictures);
  EXPECT_EQ(data["pictures"][0]["caption"], evil);
  EXPECT_EQ(data["title"], evil);
  EXPECT_EQ(data["summary"]["findings"][0]["message"], evil);
  EXPECT_EQ(data["frames"][3]["why"], evil);
}

TEST(ReportHtml, HoldsTheSummaryAsItIs) {
  for (const Record& record : {sample_go(), sample_no_go(), sample_stopped_by_constraints()})
    EXPECT_EQ(data_of(record)["summary"], Json::parse(summary_json(record)));
}

TEST(ReportHtml, BeliefsStandBesideTheTraceAndWhatIsNotStatedIsNull) {
  Record record = sample_go();
  EXPECT_FALSE(data_of(record)["trace"]["columns"].contains("stated_sigma_um")) << "none was recorded";
  for (const auto& point : record.trace)
    record.gap_beliefs.push_back({0.13e-3, point.extruding ? 5e-6 : std::nan("")});
  record.gap_belief_note = "of the gap read at the start";
  const Json data = data_of(record);
  EXPECT_EQ(data["gap_belief_note"], "of the gap read at the start");
  const Json& columns = data["trace"]["columns"];
  ASSERT_EQ(columns["stated_sigma_um"].size(), columns["gap_mm"].size());
  ASSERT_EQ(columns["believed_gap_mm"].size(), columns["gap_mm"].size());
  for (std::size_t i = 0; i < columns["gap_mm"].size(); ++i) {
    EXPECT_EQ(columns["believed_gap_mm"][i], 0.13);
    EXPECT_EQ(columns["stated_sigma_um"][i], columns["extruding"][i] == 1 ? Json(5.0) : Json());
  }
}

TEST(ReportHtml, TraceHasOneValueAPointInEveryColumn) {
  const Record record = sample_go();
  const Json data = data_of(record);
  for (const char* name : {"trace", "trace_without_gap_control"}) {
    const Json& trace = data[name];
    EXPECT_EQ(trace["points"], record.trace.size());
    const std::size_t kept = trace["columns"]["time_s"].size();
    EXPECT_GT(kept, 1000u);
    EXPECT_LE(kept, 2100u);
    EXPECT_EQ(trace["columns"].size(), 27u);
    for (const auto& [column, values] : trace["columns"].items()) EXPECT_EQ(values.size(), kept) << column;
  }
  EXPECT_TRUE(data["trace"]["columns"]["gap_mm"][0].is_null());  // nothing below the tip
  EXPECT_EQ(data["gap_band"], (Json{{"min_mm", 0.1}, {"max_mm", 0.2}, {"aim_mm", 0.13}}));
  EXPECT_EQ(data["axes"][5], (Json{{"name", "l6_mm"}, {"min", 170.0}, {"max", 240.0}}));
}

// Another processor rounds otherwise: a thousandth of what a column resolves, and its sign where there is
// nothing.
TEST(ReportHtml, RoundingStaysOutOfTheTrace) {
  const Record record = sample_go();
  Record other = record;
  double sign = 1;
  for (TracePoint& point : other.trace) {
    sign = -sign;
    for (int axis = 0; axis < 3; ++axis) {
      point.X_WT.translation()[axis] += sign * 1e-16;
      point.X_WT_programmed.translation()[axis] -= sign * 1e-16;
    }
    point.gap += sign * 1e-16;
    point.tip_error += sign * 1e-16;
    point.axes[0] += sign * 1e-16;
  }
  const Json trace = data_of(record)["trace"], same = data_of(other)["trace"];
  for (const auto& [column, values] : trace["columns"].items())
    EXPECT_TRUE(values == same["columns"][column]) << column;
}

TEST(ReportHtml, FramesCarryTheMeasuredAndTheTrueDot) {
  const Record record = sample_go();
  const Json frames = data_of(record)["frames"];
  ASSERT_EQ(frames.size(), 10u);
  const FrameRecord& first = record.frames[0];
  EXPECT_NEAR(frames[0]["measured_px"][0], first.look.dot.position_px.x(), 5e-4);  // six digits of hundreds
  EXPECT_NEAR(frames[0]["true_px"][1], first.true_dot_px->y(), 5e-4);
  EXPECT_NEAR(frames[0]["true_gap_mm"], 2.0, 1e-9);
  EXPECT_EQ(frames[0]["region"][2], 128);
  EXPECT_EQ(frames[0]["image"].get<std::string>().rfind("data:image/png;base64,iVBORw0KGgo", 0), 0u);
  EXPECT_FALSE(frames[3]["used"]);
  EXPECT_EQ(frames[3]["dot"], "saturated");
  EXPECT_FALSE(frames[3].contains("reading_mm"));
}

TEST(ReportHtml, AFrameWithoutADotOrAnImageStaysWithoutThem) {
  Record record = sample_go();
  record.frames[0].look.dot.status = vision::DotStatus::no_dot;
  record.frames[0].look.reading = {};
  record.frames[0].look.frame.image = {};
  record.frames[0].true_dot_px.reset();
  const Json frame = data_of(record)["frames"][0];
  for (const char* key : {"measured_px", "true_px", "reading_mm", "sigma_um", "image", "region"})
    EXPECT_FALSE(frame.contains(key)) << key;
}

TEST(ReportHtml, NothingSimulatedMeansNoTraceFramesOrPictures) {
  const Json data = data_of(sample_stopped_by_constraints(), {});
  EXPECT_FALSE(data.contains("trace"));
  EXPECT_FALSE(data.contains("trace_without_gap_control"));
  EXPECT_TRUE(data["frames"].empty());
  EXPECT_TRUE(data["pictures"].empty());
}

// JavaScript would round a number of 64 bits.
TEST(ReportHtml, WritesTheSeedAsText) {
  EXPECT_EQ(data_of(sample_go())["names"]["seed"], "12345678901234567890");
}

}  // namespace
}  // namespace understudy::report
