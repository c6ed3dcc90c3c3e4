#include "report/page/error_budget_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/study/sample_budget.h"

namespace understudy::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ErrorBudgetPage, DrawsBarsWithIntervalsOfWhatIsSharedOut) {
  const std::string page = error_budget_html(sample_budget());
  EXPECT_THAT(page, HasSubstr("hexapod &lt;1&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  std::size_t bars = 0;
  for (std::size_t at = page.find("<rect"); at != std::string::npos; at = page.find("<rect", at + 1)) ++bars;
  EXPECT_EQ(bars, 6u);  // two a group; the tip error has none
  EXPECT_THAT(page, HasSubstr("mounting, total"));
  EXPECT_THAT(page, HasSubstr("Not shared out: it is the same on all machines"));
  EXPECT_THAT(page, HasSubstr("tolerances.mounting"));
}

}  // namespace
}  // namespace understudy::report
