#include "vision/library_versions.h"

#include <png.h>
#include <opencv2/core/utility.hpp>

namespace understudy::vision {

LibraryVersions library_versions() {
  return {{"OpenCV", cv::getVersionString()}, {"libpng", png_get_libpng_ver(nullptr)}};
}

}  // namespace understudy::vision
