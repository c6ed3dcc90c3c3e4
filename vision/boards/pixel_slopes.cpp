#include "vision/boards/pixel_slopes.h"

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
  const double radial = 1 + r2 * (c.k1 + r2 * c.k2);
  const double slope = 2 * (c.k1 + 2 * r2 * c.k2);  // d radial / dx is slope x
  const Vec2 bent(x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
                  y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y);
  at.pixel = c.centre_px + c.focal_px * bent;

  Eigen::Matrix2d by_ray;
  by_ray << radial + slope * x * x + 2 * c.p1 * y + 6 * c.p2 * x, slope * x * y + 2 * c.p1 * x + 2 * c.p2 * y,
      slope * x * y + 2 * c.p1 * x + 2 * c.p2 * y, radial + slope * y * y + 6 * c.p1 * y + 2 * c.p2 * x;
  Eigen::Matrix<double, 2, 3> ray_by_point;
  ray_by_point << 1, 0, -x, 0, 1, -y;
  const Eigen::Matrix<double, 2, 3> by_p_C = c.focal_px / p.z() * by_ray * ray_by_point;
  Mat3 turn;  // d (exp(w) p) / dw
  turn << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  at.by_camera.leftCols<3>() = by_p_C * turn;
  at.by_camera.middleCols<3>(3) = by_p_C;
  at.by_camera.col(6) = bent;
  at.by_camera.middleCols<2>(7).setIdentity();
  const Vec2 ray(x, y);
  at.by_camera.col(9) = c.focal_px * r2 * ray;
  at.by_camera.col(10) = c.focal_px * r2 * r2 * ray;
  at.by_camera.col(11) = c.focal_px * Vec2(2 * x * y, r2 + 2 * y * y);
  at.by_camera.col(12) = c.focal_px * Vec2(r2 + 2 * x * x, 2 * x * y);
  at.by_point = by_p_C * R_CW;
  return true;
}

}  // namespace understudy::vision
