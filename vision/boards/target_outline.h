// Private to this room: the outline of a dark disc, edge by edge.
#pragma once

#include <vector>

#include "vision/boards/targets.h"

namespace understudy::vision {

struct Blob {
  Vec2 centre{0, 0};  ///< [px] of the picture, its region not added
  double radius = 0;  ///< [px], of a circle of equal area
  bool at_border = false;
};

/// Dark blobs of 0.4 to 2 times the expected area.
std::vector<Blob> find_dark_blobs(const Image& image, double radius_px);

/// Edges of the blob on rays from its centre, ellipse, centre and covariance.
TargetMeasurement measure_outline(const Image& image, const Blob& blob, const TargetOptions& options);

}  // namespace understudy::vision
