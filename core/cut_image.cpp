#include "core/cut_image.h"

namespace understudy {

Image cut(const Image& image, const Region& region) {
  const Region& whole = image.region;
  Image part{clipped(region, whole), {}};
  const int left = part.region.x, right = left + part.region.width;
  const int top = part.region.y, bottom = top + part.region.height;
  for (int y = top; y < bottom; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y - whole.y) * whole.width - whole.x;
    part.pixels.insert(part.pixels.end(), row + left, row + right);
  }
  return part;
}

}  // namespace understudy
