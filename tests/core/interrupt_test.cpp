#include "core/interrupt.h"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy {
namespace {

TEST(Interrupt, AFlagThatIsSetStopsTheWorkThatPollsIt) {
  EXPECT_NO_THROW(stop_if_interrupted());
  set_interrupted(true);
  EXPECT_TRUE(interrupted());
  EXPECT_THROW(stop_if_interrupted(), Interrupted);
  set_interrupted(false);
  EXPECT_NO_THROW(stop_if_interrupted());
}

TEST(Interrupt, ASignalSetsTheFlagAndASecondEndsTheProcess) {
  const auto once = [] {
    watch_for_interrupt();
    std::raise(SIGTERM);
    std::exit(interrupted() ? 0 : 1);
  };
  EXPECT_EXIT(once(), testing::ExitedWithCode(0), "");
  const auto twice = [] {
    watch_for_interrupt();
    std::raise(SIGINT);
    std::raise(SIGINT);
    std::exit(0);
  };
  EXPECT_EXIT(twice(), testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace understudy
