#include "vision/boards/calibration_rig.h"

#include <cmath>

namespace understudy::vision {

BoardPlacement sample_placement(const BoardTolerance& tolerance, Random& random) {
  BoardPlacement p;
  for (int i = 0; i < 3; ++i) p.offset[i] = tolerance.offset * random.normal();
  for (int i = 0; i < 3; ++i) p.rotation[i] = tolerance.rotation * random.normal();
  p.scale = tolerance.scale * random.normal();
  return p;
}

PrintError sample_print(const BoardTolerance& tolerance, Random& random) {
  PrintError print;
  print.scale = tolerance.print_scale * random.normal();
  for (int i = 0; i < 3; ++i) print.bow[i] = tolerance.flatness * random.normal();
  return print;
}

Pose CalibrationRig::X_WG(int camera, int layer) const {
  const double depth = middle_distance + layer_spacing * (layer - 0.5 * (layers - 1));
  return cameras[static_cast<std::size_t>(camera)].X_WC * Pose(Eigen::Translation3d(0, 0, depth));
}

CalibrationRig default_calibration_rig(const Vec3& home_tip_W) {
  CalibrationRig rig;
  const double leg = 60e-3 / std::sqrt(2.0);
  rig.targets = {Vec3(0, 0, 0), Vec3(leg, 0, leg), Vec3(0, leg, leg)};
  rig.target_radius = 5e-3;
  const Vec3 middle = home_tip_W + (rig.targets[0] + rig.targets[1] + rig.targets[2]) / 3;

  const Camera camera{.width = 1600, .height = 1200, .focal_px = 4267, .centre_px = {799.5, 599.5}};
  const Vec3 optical_axes[] = {Vec3::UnitX(), Vec3::UnitY()};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 down = -Vec3::UnitZ();
    Mat3 R;
    R << down.cross(optical_axes[i]), down, optical_axes[i];
    rig.cameras[i] = {camera, make_pose(R, Vec3(middle - rig.middle_distance * optical_axes[i]))};
  }
  return rig;
}

}  // namespace understudy::vision
