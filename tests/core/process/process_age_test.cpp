#include "core/process/process_age.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(ProcessAge, GrowsWithTheClock) {
  const double before = process_age();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const double after = process_age();
  EXPECT_GE(before, 0);
  EXPECT_LT(before, 3600) << "since this test began, not since the machine did";
  EXPECT_GE(after - before, 0.2 - 1e-3);
  EXPECT_LT(after - before, 30) << "whatever else runs here";
}

}  // namespace
}  // namespace understudy
