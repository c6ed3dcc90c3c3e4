// Grey pictures as a camera delivers them, and the pinhole camera that makes and reads them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/frames.h"

namespace understudy {

/// A rectangle of sensor pixels.
struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool operator==(const Region&) const = default;
};
/// What of `region` lies in `within`, which has a size; beside it nothing, at its border.
Region clipped(const Region& region, const Region& within);

/// 8-bit grey, row-major, top row first. `region` says where on the sensor it was read out.
struct Image {
  Region region;
  std::vector<std::uint8_t> pixels;

  int width() const { return region.width; }
  int height() const { return region.height; }
  std::uint8_t at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(region.width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Pinhole camera with Brown distortion. Pixel (0, 0) is the centre of the top-left pixel; x right, y down.
struct Camera {
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double focal_px = 0;    ///< [px], square pixels
  Vec2 centre_px{0, 0};   ///< [px], principal point
  double k1 = 0, k2 = 0;  ///< radial distortion
  double p1 = 0, p2 = 0;  ///< tangential distortion

  /// All of its pixels.
  Region sensor() const { return {0, 0, width, height}; }
  /// Pixel of a point in camera coordinates, or nothing when it lies behind the camera.
  std::optional<Vec2> project(const Vec3& p_C) const;
};

}  // namespace understudy
