#include "vision/library_versions.h"

#include <opencv2/core/utility.hpp>

namespace understudy::vision {

LibraryVersions library_versions() { return {{"OpenCV", cv::getVersionString()}}; }

}  // namespace understudy::vision
