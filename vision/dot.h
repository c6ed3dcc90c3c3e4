// Sub-pixel position of the laser dot in a grey image, with covariance (Song 2015, 3.3; reference D).
#pragma once

#include "core/image.h"

namespace understudy::vision {

enum class DotStatus { ok, no_dot, saturated, clipped_by_border, not_a_spot };
const char* to_string(DotStatus s);

struct DotOptions {
  double expected_radius_px = 5;      ///< 1/e^2 radius of the spot in the image
  double saturated_fraction_max = 0.02;  ///< of the spot's pixels at 255
  double contrast_min = 12;           ///< grey levels of the spot over its surroundings
};

struct DotMeasurement {
  DotStatus status = DotStatus::no_dot;
  Vec2 position_px{0, 0};               ///< on the sensor (the image's region is added)
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double contrast = 0;                  ///< grey levels
  double radius_px = 0;                 ///< 1/e^2, geometric mean of both axes
  double saturated_fraction = 0;
};

/// Weighted centroid above the surroundings: under speckle it beats a Gaussian fit. Never throws.
DotMeasurement measure_dot(const Image& image, const DotOptions& options);

}  // namespace understudy::vision
