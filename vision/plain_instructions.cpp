#include "vision/plain_instructions.h"

#include <opencv2/core/utility.hpp>

namespace understudy::vision {

void hold_opencv_to_plain_instructions() {
  cv::setNumThreads(1);
  cv::setUseOptimized(false);
}

}  // namespace understudy::vision
