// A hexapod before two cameras whose pixels are projected, not rendered: the truth comes from Camera::project
// and from forward kinematics alone.
#pragma once

#include <cmath>
#include <stdexcept>

#include "calibration/bundle/bundle_problem.h"
#include "calibration/machine/strut_sides.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "core/random_vector.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "tests/shipped_hexapod.h"

namespace understudy::calibration {

struct DrawnSetting {
  vision::BoardTolerance boards{0.2e-3, 2e-3, 0, 1e-3, 0.05e-3};
  double corner_px = 0.04, target_px = 0.05;
  double machine = 0.5e-3;  ///< [m], error of every parameter
  DriveTolerance drives{.length = 3.5e-6, .lead = 0.17e-3};
  std::size_t poses = 24;
  bool noise = true;
  double play = 0;  ///< [m], of each strut: gravity decides where it rests
};

/// What was measured, and the truth behind it.
struct DrawnBundle {
  BundleProblem problem;
  BundleState truth;
};

inline std::array<vision::MountedCamera, 2> drawn_cameras(const vision::CalibrationRig& rig, Random& random) {
  auto cameras = rig.cameras;
  for (vision::MountedCamera& m : cameras) {
    m.camera.focal_px *= 1 + 3e-3 * random.normal();
    m.camera.centre_px += 0.1 * normal_vec2(random);
    m.camera.k1 = random.uniform(-0.12, 0.12);
    m.camera.k2 = random.uniform(-0.15, 0.15);
    m.camera.p1 = random.uniform(-5e-4, 5e-4);
    m.camera.p2 = random.uniform(-5e-4, 5e-4);
    const Vec3 turn = 2e-3 * normal_vec3(random), shift = 0.3e-3 * normal_vec3(random);
    m.X_WC = m.X_WC * make_pose(exp_rotation(turn), shift);
  }
  return cameras;
}

inline Vec2 drawn_pixel(const vision::MountedCamera& camera, const Vec3& p_W, double sigma, Random& random) {
  return camera.camera.project(camera.X_WC.inverse() * p_W).value() + sigma * normal_vec2(random);
}

inline vision::SeenBoard drawn_board(const DrawnBundle& drawn, int camera, int layer, std::size_t b,
                                     double sigma, Random& random) {
  const vision::CalibrationRig& rig = drawn.problem.rig;
  const auto c = static_cast<std::size_t>(camera);
  vision::SeenBoard seen{camera, layer, {}};
  for (int i = 0; i < rig.board.corners(); ++i) {
    const Vec3 drawing = rig.board.corner(i % rig.board.columns, i / rig.board.columns);
    const Vec3 p_G = drawn.truth.boards[b].moved(drawn.truth.prints[c].printed(rig.board, drawing));
    seen.corners_px.push_back(
        drawn_pixel(drawn.truth.cameras[c], rig.X_WG(camera, layer) * p_G, sigma, random));
  }
  return seen;
}

/// Boards, prints and leads are off by normal numbers of their tolerance.
inline DrawnBundle draw_bundle(const DrawnSetting& setting, std::uint64_t seed) {
  Random random(seed, "drawn bundle");
  const double noise = setting.noise ? 1 : 0;
  DrawnBundle drawn;
  BundleProblem& problem = drawn.problem;
  problem.rig = vision::default_calibration_rig((hexapod().X_WB * hexapod().X_BT_home).translation());
  problem.uncertainty = {.boards = setting.boards, .corner_px = setting.corner_px, .principal_px = 0.1};
  problem.X_WB = hexapod().X_WB;
  problem.nominal = {hexapod().hexapod().geometry, {}};
  problem.drives = setting.drives;
  drawn.truth.cameras = drawn_cameras(problem.rig, random);
  drawn.truth.machine = {perturbed(problem.nominal.geometry, setting.machine, random), {}};
  for (double& lead : drawn.truth.lead) lead = setting.drives.lead * random.normal();
  for (int camera = 0; camera < 2; ++camera) {
    drawn.truth.prints[static_cast<std::size_t>(camera)] = sample_print(setting.boards, random);
    for (int layer = 0; layer < problem.rig.layers; ++layer) {
      drawn.truth.boards.push_back(sample_placement(setting.boards, random));
      problem.boards.push_back(drawn_board(drawn, camera, layer, drawn.truth.boards.size() - 1,
                                           noise * setting.corner_px, random));
    }
  }
  const auto mechanism = hexapod().make_mechanism();
  PoseRegion region = reference_region(hexapod().X_BT_home);
  region.half_size = Vec3::Constant(40e-3);
  for (const Pose& X_BT : random_reachable_poses(*mechanism, region, setting.poses, random)) {
    BundlePose pose;
    pose.number = static_cast<int>(problem.poses.size()) + 1;
    pose.X_BT = X_BT;
    StrutLengths lengths;
    if (kinematics::inverse(problem.nominal.geometry, X_BT, lengths) != kinematics::SolveStatus::ok)
      throw std::logic_error("a reachable pose has no lengths");
    pose.displacement = displacements(problem.nominal.geometry, lengths);
    for (std::size_t i = 0; i < kStruts; ++i)
      lengths[i] = drawn.truth.machine.geometry.length_offset[i] +
                   (1 + drawn.truth.lead[i]) * pose.displacement[i] +
                   noise * setting.drives.length * random.normal();
    auto reached = kinematics::forward(drawn.truth.machine.geometry, lengths, X_BT);
    StrutLengths load;
    if (!strut_loads(hexapod(), drawn.truth.machine.geometry, reached.X_BT, load))
      throw std::logic_error("a reachable pose is singular");
    for (std::size_t i = 0; i < kStruts; ++i) lengths[i] -= std::copysign(0.5 * setting.play, load[i]);
    reached = kinematics::forward(drawn.truth.machine.geometry, lengths, X_BT);
    if (reached.status != kinematics::SolveStatus::ok) throw std::logic_error("a true pose is out of reach");
    drawn.truth.poses.push_back(reached.X_BT);
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t k = 0; k < 3; ++k) {
        pose.targets[c][k].pixel =
            drawn_pixel(drawn.truth.cameras[c], problem.X_WB * (reached.X_BT * problem.rig.targets[k]),
                        noise * setting.target_px, random);
        pose.targets[c][k].covariance = setting.target_px * setting.target_px * Eigen::Matrix2d::Identity();
      }
    problem.poses.push_back(pose);
  }
  return drawn;
}

}  // namespace understudy::calibration
