// The page as a browser draws it. Slow: each case starts a headless Chromium.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include "core/file/output_file.h"
#include "report/page/report_html.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

using namespace rehearsal;

class SlowReportPage : public testing::Test {
 protected:
  SlowReportPage() {
    folder_ = fs::temp_directory_path() / ("report-page-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  ~SlowReportPage() override { fs::remove_all(folder_); }
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  }

  /// What stands in <main> after the scripts have run, without the pictures' bytes.
  std::string drawn(const Record& record) {
    write_file(folder_ / "report.html",
               report_html(record, record.trace.empty() ? std::vector<Illustration>() : sample_pictures()));
    const std::string command =
        "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
        "--disable-background-networking --disable-component-update --disable-sync "
        "--virtual-time-budget=4000 "
        "--window-size=1280,3000 --user-data-dir='" +
        (folder_ / "profile").string() + "' --dump-dom 'file://" + (folder_ / "report.html").string() +
        "' 2> /dev/null";
    std::string dom;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 65536> block;
    for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
      dom.append(block.data(), n);
    EXPECT_EQ(::pclose(pipe), 0);
    const std::size_t main = dom.find("<main id=\"page\"");
    dom = dom.substr(main, dom.find("</main>", main) - main);
    for (std::size_t at = dom.find("base64,"); at != std::string::npos; at = dom.find("base64,", at + 1))
      dom.erase(at + 7, dom.find('"', at) - at - 7);
    return dom;
  }
  static std::size_t count(const std::string& text, const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
  }

  fs::path folder_;
};

TEST_F(SlowReportPage, AGoShowsVerdictChartsFramesAndFigures) {
  const std::string page = drawn(sample_go());
  EXPECT_EQ(count(page, "<strong>GO with warnings</strong>"), 1u);
  EXPECT_EQ(count(page, "class=\"chart\""), 3u);
  EXPECT_EQ(count(page, "<canvas"), 6u);                       // dygraphs stacks two on every chart
  EXPECT_EQ(count(page, "class=\"dot measured\""), 10u + 1u);  // the frames and the key
  EXPECT_EQ(count(page, "class=\"dot true\""), 10u + 1u);
  EXPECT_EQ(count(page, "<image"), 10u);
  EXPECT_NE(page.find(">without gap control<"), std::string::npos);
  EXPECT_NE(page.find("12345678901234567890"), std::string::npos);
  for (const char* text : {"NaN", "undefined", "[object", "Infinity"})
    EXPECT_EQ(page.find(text), std::string::npos) << text;
}

// 27 errors of two kinds and 3 warnings of one.
TEST_F(SlowReportPage, AlikeFindingsAreOneRowAndEachIsFolded) {
  const std::string page = drawn(sample_no_go());
  EXPECT_EQ(count(page, "<strong>NO-GO</strong>"), 1u);
  const std::size_t fold = page.find("<details");
  ASSERT_NE(fold, std::string::npos);
  const std::string open = page.substr(0, fold), folded = page.substr(fold);
  EXPECT_EQ(count(open, "class=\"severity error\""), 2u);
  EXPECT_EQ(count(open, "class=\"severity warning\""), 1u);
  EXPECT_LT(open.find("class=\"severity error\""), open.find("class=\"severity warning\""));
  EXPECT_GT(count(open, "class=\"advice\""), 0u);
  EXPECT_EQ(count(folded, "class=\"severity error\""), 27u);
  EXPECT_EQ(count(folded, "class=\"severity warning\""), 3u);
}

TEST_F(SlowReportPage, WithoutASimulationThereIsNothingDrawn) {
  const std::string page = drawn(sample_stopped_by_constraints());
  EXPECT_EQ(count(page, "<canvas"), 0u);
  EXPECT_NE(page.find("The program was not run"), std::string::npos);
  EXPECT_EQ(page.find("Figures"), std::string::npos);
  EXPECT_EQ(count(page, "class=\"severity error\""), 2u);
}

TEST_F(SlowReportPage, ACalibrationHasItsTableAndItsChart) {
  Record record = sample_go();
  record.calibration = CalibrationFigures{"hexapod", "m.yaml", "", AccuracyFigures{4000, 5000, 6000, 7, 0},
                                          AccuracyFigures{40, 50, 60, 0.7, 0}};
  record.trace_before_calibration = record.trace_without_gap_control;
  const std::string page = drawn(record);
  EXPECT_EQ(count(page, "Tip error before and after calibration"), 1u);
  EXPECT_EQ(count(page, "class=\"comparison\""), 1u);
  EXPECT_EQ(count(page, "class=\"chart\""), 4u);
  EXPECT_NE(page.find(">before, hexapod<"), std::string::npos);
  EXPECT_NE(page.find(">100<"), std::string::npos);  // 4000 / 40
  for (const char* text : {"NaN", "undefined", "Infinity"})
    EXPECT_EQ(page.find(text), std::string::npos) << text;
  record.trace_before_calibration.clear();
  record.calibration->before.reset();
  record.calibration->not_run_before = "strut 3 is 241.7 mm, longer than 240.0 mm";
  const std::string without = drawn(record);
  EXPECT_EQ(count(without, "class=\"comparison\""), 0u);
  EXPECT_NE(without.find("Not compared: with the description before, hexapod"), std::string::npos);
}

TEST_F(SlowReportPage, WhatTheControllerBelievesIsABandOrALineInWords) {
  Record record = sample_go();
  record.gap_belief_note = "of the gap read at the start";
  EXPECT_NE(drawn(record).find("No band of what the controller believes"), std::string::npos);
  for (const auto& point : record.trace)
    record.gap_beliefs.push_back({0.13e-3, point.extruding ? 5e-6 : std::nan("")});
  record.gap->stated_sigma_um = 5;
  record.gap->stated_path_fraction = 1;
  record.gap->inside_stated_3_sigma_fraction = 0.25;
  const std::string page = drawn(record);
  EXPECT_NE(page.find("Blue band: what the controller believes"), std::string::npos);
  EXPECT_NE(page.find("the true gap is inside on 25.0"), std::string::npos);
  for (const char* text : {"NaN", "undefined", "Infinity"})
    EXPECT_EQ(page.find(text), std::string::npos) << text;
}

TEST_F(SlowReportPage, MarkupInMessagesIsShownAsText) {
  Record record = sample_stopped_by_constraints();
  record.findings[0].message = "<img src=x onerror=\"document.title='owned'\"></script><b>";
  const std::string page = drawn(record);
  EXPECT_EQ(count(page, "<img"), 0u);
  EXPECT_NE(page.find("&lt;img src=x"), std::string::npos);
}

}  // namespace
}  // namespace understudy::report
