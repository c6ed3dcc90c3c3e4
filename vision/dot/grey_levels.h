// Private to this room: how bright a picture is, before anything is looked for in it.
#pragma once

#include "core/image.h"

namespace understudy::vision {

struct GreyLevels {
  double dark = 0;                ///< grey level that 2 % of the pixels stay below
  double bright = 0;              ///< grey level that 2 % exceed
  double saturated_fraction = 0;  ///< of the pixels at 255
};

/// Whether the picture is not empty and has as many pixels as its region says.
bool has_pixels(const Image& image);
GreyLevels grey_levels(const Image& image);

}  // namespace understudy::vision
