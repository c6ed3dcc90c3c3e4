// A part of a picture.
#pragma once

#include "core/image.h"

namespace understudy {

/// What of the picture lies in `region`, in pixels of the sensor; the region is clipped to the picture.
Image cut(const Image& image, const Region& region);

}  // namespace understudy
