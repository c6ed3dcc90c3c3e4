// How well it is known where the measuring device itself stands. Its error is the same in all poses:
// residuals do not show it, and more poses do not average it out.
#pragma once

#include <vector>

#include "core/frames.h"

namespace understudy::calibration {

/// 1 sigma of the frame in which poses were measured, about the middle of the measured tips.
struct MeasuringFrame {
  double position = 0;  ///< [m], each axis
  double rotation = 0;  ///< [rad], about each axis
  double strain = 0;    ///< of its scale along each axis, and of its shear

  /// What it does to a point `from_middle` [m]: position^2 I + rotation^2 (r^2 I - r r^T) + strain^2 times r
  /// r^T with r^2 on its diagonal.
  Mat3 covariance(const Vec3& from_middle) const;
  bool operator==(const MeasuringFrame&) const = default;
};

/// One pose as several measuring devices would see it that could all stand there: shift r of every pose
/// belongs to device r.
struct SharedError {
  Vec3 tip{0, 0, 0};          ///< [m], measured
  std::vector<Twist> shifts;  ///< (tip [m], rotation vector [rad]), as the covariance of a pose
  Mat6 left = Mat6::Zero();   ///< set: what of the shifts no motion of the frame explains
};

/// The frame's motion and strain that explain the shifts of all poses best, device by device; 1 sigma over
/// the devices. All poses must tell of equally many.
MeasuringFrame measuring_frame(std::vector<SharedError>& poses);

}  // namespace understudy::calibration
