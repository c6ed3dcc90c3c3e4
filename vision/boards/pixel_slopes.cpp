#include "vision/boards/pixel_slopes.h"

#include "core/brown_model.h"
#include "core/cross_matrix.h"

namespace understudy::vision {

MountedCamera moved(const MountedCamera& camera, const CameraStep& by) {
  MountedCamera to = camera;
  const Pose step = make_pose(exp_rotation(by.head<3>()), Vec3(by.segment<3>(3)));
  to.X_WC = camera.X_WC * step.inverse();
  to.camera.focal_px += by[6];
  to.camera.centre_px += by.segment<2>(7);
  to.camera.k1 += by[9];
  to.camera.k2 += by[10];
  to.camera.p1 += by[11];
  to.camera.p2 += by[12];
  return to;
}

bool pixel_slopes(const MountedCamera& mounted, const Vec3& p_W, PixelSlopes& at) {
  const Camera& c = mounted.camera;
  const Mat3 R_CW = mounted.X_WC.linear().transpose();
  const Vec3 p = R_CW * (p_W - mounted.X_WC.translation());
  if (!(p.z() > 0)) return false;
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  const Vec2 ray(x, y);
  const DistortedRay seen = distort(c, ray);
  at.pixel = c.centre_px + c.focal_px * seen.ray;

  Eigen::Matrix<double, 2, 3> ray_by_point;
  ray_by_point << 1, 0, -x, 0, 1, -y;
  const Eigen::Matrix<double, 2, 3> by_p_C = c.focal_px / p.z() * seen.slopes * ray_by_point;
  at.by_camera.leftCols<3>() = by_p_C * -cross_matrix(p);  // d (exp(w) p) / dw
  at.by_camera.middleCols<3>(3) = by_p_C;
  at.by_camera.col(6) = seen.ray;
  at.by_camera.middleCols<2>(7).setIdentity();
  at.by_camera.col(9) = c.focal_px * r2 * ray;
  at.by_camera.col(10) = c.focal_px * r2 * r2 * ray;
  at.by_camera.col(11) = c.focal_px * Vec2(2 * x * y, r2 + 2 * y * y);
  at.by_camera.col(12) = c.focal_px * Vec2(r2 + 2 * x * x, 2 * x * y);
  at.by_point = by_p_C * R_CW;
  return true;
}

}  // namespace understudy::vision
