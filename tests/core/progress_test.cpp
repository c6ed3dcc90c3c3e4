#include "core/progress.h"

#include <gtest/gtest.h>

#include "tests/told_progress.h"

namespace understudy {
namespace {

TEST(Progress, StagesFillTheTaskOneAfterTheOther) {
  test::ToldProgress told;
  const Progress first = stage_of(told.teller(), 0, 0.25), second = stage_of(told.teller(), 0.25, 1);
  for (std::size_t i = 1; i <= 4; ++i) tell(first, i, 4, "first");
  for (std::size_t i = 1; i <= 4; ++i) tell(second, i, 4, "second");
  told.expect_even(0.1875);  // a quarter of three quarters
  EXPECT_EQ(told.stages(), (std::set<std::string>{"first", "second"}));
}

TEST(Progress, OfAStageThatNobodyLooksAtNothingIsTold) {
  EXPECT_FALSE(stage_of({}, 0, 1));
  tell(stage_of({}, 0, 1), 1, 2, "nothing");
}

}  // namespace
}  // namespace understudy
