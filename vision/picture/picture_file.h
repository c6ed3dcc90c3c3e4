// Pictures of cameras as files: PNG and whatever else OpenCV decodes.
#pragma once

#include <string>

#include "core/image.h"

namespace understudy::vision {

/// The file as 8-bit grey: colour by its luminance, 16 bits by their upper 8. The orientation that a camera
/// notes in the file is disregarded, because a calibration belongs to the sensor. Throws InputError naming
/// the file: it cannot be read, holds no picture, or one of more than 100 million pixels.
Image read_picture(const std::string& file);

}  // namespace understudy::vision
