#include "report/page/scenario_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

IndexedScenario scenario(const std::string& name, bool ok) {
  IndexedScenario each;
  each.result.name = name;
  each.result.seconds = 1.5;
  regression::Check check;
  check.ok = ok;
  check.name = "gap.start_mm <= 0.2 mm";
  check.expectation.metric = "gap.start_mm";
  check.expectation.max = 0.2;
  check.expectation.unit = "mm";
  check.expectation.source = "Song 2015, 3.3";
  check.value = ok ? 0.15 : 0.25;
  each.result.checks = {check};
  each.folder = name;
  each.picture = name + "/pictures/picture-01.png";
  each.replay = "understudy scenario run " + name + ".yaml";
  return each;
}

TEST(ScenarioIndex, FailuresComeFirstWithValueBoundSourceAndTheCommand) {
  const std::vector scenarios{scenario("good", true), scenario("bad", false)};
  const std::string html = scenario_index_html(scenarios, {});
  EXPECT_THAT(html, HasSubstr(kIndexMark));
  EXPECT_THAT(html, HasSubstr("1 passed, 1 failed"));
  EXPECT_LT(html.find("id=\"bad\""), html.find("id=\"good\""));
  for (const char* part :
       {"0.25 mm", "gap.<wbr>start_<wbr>mm &lt;= 0.2 mm", "Song 2015, 3.3",
        "understudy scenario run bad.yaml", "bad/pictures/picture-01.png", "bad/report.html"})
    EXPECT_THAT(html, HasSubstr(part));
  EXPECT_THAT(html, Not(HasSubstr("http"))) << "opens without a network";
}

TEST(ScenarioIndex, ShowsEarlierRunsAndWhatDiffersFromTheBaseline) {
  std::vector scenarios{scenario("bottle", true)};
  scenarios[0].changes = {{"gap.start_mm", 0.134198, 0.15}};
  PastRun past;
  past.scenarios["bottle"] = {false, 1, {{"gap.start_mm <= 0.2 mm", 0.3}}};
  const std::string without = scenario_index_html(scenarios, {});
  const std::string with = scenario_index_html(scenarios, std::vector{past});
  EXPECT_THAT(without, HasSubstr("gap.start_mm was 0.134198 mm, is 0.15 mm"));
  EXPECT_THAT(without, Not(HasSubstr("<polyline")));
  EXPECT_THAT(with, HasSubstr("<polyline"));
  EXPECT_THAT(with, HasSubstr("0.15 to 0.3 in 2 runs"));
  EXPECT_THAT(with, HasSubstr("stroke-dasharray")) << "the bound lies between the values";
}

TEST(ScenarioIndex, NamesAreText) {
  const std::vector scenarios{scenario("<script>alert(1)</script>", true)};
  EXPECT_THAT(scenario_index_html(scenarios, {}), Not(HasSubstr("<script>")));
}

}  // namespace
}  // namespace understudy::report
