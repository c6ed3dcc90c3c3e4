#include "report/page/comparison_page.h"
#include "report/page/comparison_tables.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kEvil = "</title><script>window.evil = 1</script>\"\x1b[31m";

class ComparisonPage : public testing::Test {
 protected:
  ComparisonPage() {
    for (RecordedRehearsal* result : {&a_, &b_}) {
      const bool of_a = result == &a_;
      result->folder = folder_ / (of_a ? "a" : "b");
      std::filesystem::create_directories(result->folder);
      result->grade = of_a ? rehearsal::Grade::go : rehearsal::Grade::no_go;
      result->inputs = {{"seed", of_a ? "4" : "5"}, {"program file", std::string(64, of_a ? 'a' : 'b')}};
      result->figures = {{"gap.in_band_fraction", of_a ? 1.0 : 0.504283},
                         {"collision.checks", of_a ? 40806. : 38486.}};
      for (int i = 0; i < 6; ++i) {
        rehearsal::TracePoint point;
        point.time = i;
        point.path = 1e-3 * i;
        point.extruding = i != 3;  // the curve pauses there
        point.gap = 0.13e-3;
        point.tip_error = 1e-5 * i;
        result->trace.push_back(point);
      }
    }
  }
  std::string page() const { return comparison_html(compare_rehearsals(a_, b_), a_, b_); }
  std::string text() const { return comparison_text(compare_rehearsals(a_, b_), a_, b_); }

  TemporaryFolder folder_;
  RecordedRehearsal a_, b_;
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST_F(ComparisonPage, SaysTheAnswerFirstAndDrawsBothCurvesWithTheirPauses) {
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<strong>GO \u2192 NO-GO</strong>"));
  EXPECT_LT(html.find("class=\"verdict no-go\""), html.find("Figures that differ"));
  EXPECT_THAT(html, HasSubstr("2 figures differ; inputs differ in program file, seed."));
  EXPECT_EQ(count(html, "stroke-dasharray=\"7 4\"/>"),
            9u);  // two pieces in each of four charts, and the legend
  EXPECT_THAT(html, HasSubstr("Gap along time"));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
}

TEST_F(ComparisonPage, WithoutCurvesItHasNone) {
  a_.trace.clear();
  b_.trace.clear();
  EXPECT_THAT(page(), Not(HasSubstr("<svg")));
}

TEST_F(ComparisonPage, NamesOfStrangersStayText) {
  a_.inputs[kEvil] = kEvil;
  a_.run.command = kEvil;
  a_.folder = folder_ / "a";
  a_.figures["placement.least"] = kEvil;
  a_.findings.emplace_back();
  a_.findings[0].worst.kind = a_.findings[0].worst.message = kEvil;
  EXPECT_THAT(page(), Not(HasSubstr("<script>")));
  EXPECT_THAT(text(), Not(HasSubstr("\x1b")));
}

TEST_F(ComparisonPage, TheTerminalHasShortTables) {
  const std::string words = text();
  EXPECT_THAT(words, HasSubstr("GO -> NO-GO: 2 figures differ"));
  EXPECT_THAT(words, HasSubstr("program file  sha256 aaaaaaaaaaaa  sha256 bbbbbbbbbbbb"));
  EXPECT_THAT(words, testing::ContainsRegex("gap.in_band_fraction +1 +0.5043 +-0.4957 +-49.6 %"));
  EXPECT_THAT(words, testing::ContainsRegex("collision.checks +40806 +38486 +-2320 +-5.7 %"));
}

}  // namespace
}  // namespace understudy::report
