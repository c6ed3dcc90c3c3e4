// Centres of the spherical targets on the moving platform, dark before a lit backdrop (Song 2015, section 4
// and appendix B.2; docs/reference.md#two-cameras).
#pragma once

#include <array>

#include "core/image.h"

namespace understudy::vision {

enum class TargetStatus {
  ok,
  missing,            ///< nothing of a target's size near where it is expected
  partly_hidden,      ///< part of the outline is not the outline of a sphere
  clipped_by_border,  ///< the outline reaches the picture's edge
  overexposed,
  low_contrast,
  ambiguous,  ///< two blobs could be this target, or this blob two targets
};
const char* to_string(TargetStatus s);

struct TargetOptions {
  /// The lens as known: removes the outline's lopsidedness and gives the displacement from the outline's
  /// centre to the sphere's. A percent of error in its focal length matters 0.002 px.
  Camera camera;
  double radius_px = 53;  ///< expected
  /// How far a target may be from where it is expected. Below half the distance between two targets nothing
  /// is ambiguous (60 mm are 640 px in the default rig, at least 400 px in either view).
  double search_px = 150;
  double contrast_min = 40;              ///< grey levels of backdrop over target
  double saturated_fraction_max = 0.05;  ///< of the pixels around a target at 255
  double hidden_fraction_max = 0.15;     ///< of the outline that does not belong to a sphere
};

struct TargetMeasurement {
  TargetStatus status = TargetStatus::missing;
  Vec2 centre_px{0, 0};   ///< projection of the sphere's centre, on the sensor
  Vec2 outline_px{0, 0};  ///< centre of the outline: not the same, see below
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();  ///< of centre_px
  double radius_px = 0;        ///< of the outline, across the direction to the lens's axis
  double edge_scatter_px = 0;  ///< 1 sigma of an edge about the ellipse
  double contrast = 0;         ///< grey levels
};

struct TargetsMeasurement {
  TargetStatus status = TargetStatus::missing;  ///< ok, or that of the first target that is not
  int failed_target = -1;
  std::array<TargetMeasurement, 3> targets;
};

/// `expected_px` says which target is which (the sensor's pixels at the pose that the machine was sent
/// to: a machine before calibration misses by 3 mm, 32 px): every blob belongs to the nearest expectation.
/// Each outline is measured by edges on radial lines, an ellipse is fitted to them (Halir and Flusser's
/// direct method in OpenCV, outliers dropped) and corrected for the projected centre: with the half-width b
/// of the outline across the direction to the lens's axis, (b / f)^2 = R^2 / (Z^2 - R^2) = q, and the
/// sphere's centre is at 1 / (1 + q) of the outline's distance from the axis. Never throws for what a picture
/// holds.
TargetsMeasurement measure_targets(const Image& image, const std::array<Vec2, 3>& expected_px,
                                   const TargetOptions& options);

/// Centre of the blob's moments, without edges and without correction: what the above is compared with.
Vec2 moment_centre(const Image& image, const Vec2& near_px, double radius_px);

}  // namespace understudy::vision
