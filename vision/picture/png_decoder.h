// Private to this folder: the bytes of a PNG as grey levels, by libpng.
#pragma once

#include <string>

#include "core/image.h"

namespace understudy::vision {

bool is_png(const std::string& bytes);

/// 8-bit grey: colours weighed as 0.299 R + 0.587 G + 0.114 B, the high byte of 16 bits, transparency left
/// out. An image of no pixels where the bytes are no whole PNG. The caller has looked at the size that its
/// header promises.
Image decode_png(const std::string& bytes);

}  // namespace understudy::vision
