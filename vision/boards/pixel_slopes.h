// Where a mounted camera sees a point, and how that moves with the camera's numbers and with the point.
#pragma once

#include "vision/boards/calibration_rig.h"

namespace understudy::vision {

constexpr int kCameraNumbers = 13;
/// A step of a mounted camera: rotation vector [rad] and translation [m] of what it sees, told in C (p_C
/// becomes exp(w) p_C + t), focal length and centre [px], k1, k2, p1, p2.
using CameraStep = Eigen::Matrix<double, kCameraNumbers, 1>;

MountedCamera moved(const MountedCamera& camera, const CameraStep& by);

struct PixelSlopes {
  Vec2 pixel{0, 0};
  Eigen::Matrix<double, 2, kCameraNumbers> by_camera;  ///< d pixel / d step, at step 0
  Eigen::Matrix<double, 2, 3> by_point;                ///< d pixel / d p_W [px/m]
};

/// False for a point that does not lie before the camera.
bool pixel_slopes(const MountedCamera& camera, const Vec3& p_W, PixelSlopes& at);

}  // namespace understudy::vision
