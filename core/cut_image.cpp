#include "core/cut_image.h"

#include <algorithm>

namespace understudy {

Image cut(const Image& image, const Region& region) {
  const Region& whole = image.region;
  const int left = std::clamp(region.x, whole.x, whole.x + whole.width);
  const int top = std::clamp(region.y, whole.y, whole.y + whole.height);
  const int right = std::clamp(region.x + region.width, left, whole.x + whole.width);
  const int bottom = std::clamp(region.y + region.height, top, whole.y + whole.height);
  Image part{{left, top, right - left, bottom - top}, {}};
  for (int y = top; y < bottom; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y - whole.y) * whole.width - whole.x;
    part.pixels.insert(part.pixels.end(), row + left, row + right);
  }
  return part;
}

}  // namespace understudy
