#include "vision/plain_instructions.h"

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

namespace understudy::vision {
namespace {

TEST(PlainInstructions, OpencvHasOneThreadAndNoWayOfItsOwn) {
  const int threads = cv::getNumThreads();
  const bool optimized = cv::useOptimized();
  hold_opencv_to_plain_instructions();
  EXPECT_EQ(cv::getNumThreads(), 1);
  EXPECT_FALSE(cv::useOptimized());
  EXPECT_FALSE(cv::checkHardwareSupport(CV_CPU_AVX2));
  EXPECT_FALSE(cv::checkHardwareSupport(CV_CPU_FMA3));
  cv::setNumThreads(threads);
  cv::setUseOptimized(optimized);
}

}  // namespace
}  // namespace understudy::vision
