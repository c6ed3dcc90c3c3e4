#include "vision/dot/grey_levels.h"

#include <array>

namespace understudy::vision {

bool has_pixels(const Image& image) {
  return image.width() > 0 && image.height() > 0 &&
         image.pixels.size() ==
             static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

GreyLevels grey_levels(const Image& image) {
  std::array<std::size_t, 256> histogram{};
  for (const std::uint8_t p : image.pixels) ++histogram[p];
  const auto total = static_cast<double>(image.pixels.size());
  const auto quantile = [&](double share) {
    double below = 0;
    for (std::size_t level = 0; level < histogram.size(); ++level) {
      below += static_cast<double>(histogram[level]);
      if (below >= share * total) return static_cast<double>(level);
    }
    return 255.0;
  };
  return {quantile(0.02), quantile(0.98), static_cast<double>(histogram[255]) / total};
}

}  // namespace understudy::vision
