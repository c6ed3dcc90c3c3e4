// What the two tolerance sets of the shipped hexapod mean at the tip: kinematics alone, no play.
//
// A machine's tip error is the RMS, over poses of its workspace, of the distance between where the controller
// thinks the tip is and where the as-built geometry puts it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/quantile.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::machine {
namespace {

/// Poses within every limit, in the 100 mm cube about home (Song 2015), tilted up to 20 degrees any way.
std::vector<Pose> workspace_poses(const MachineDescription& m, int count) {
  Random random(1, "workspace poses");
  std::vector<Pose> poses;
  std::vector<kinematics::LimitViolation> violations;
  while (static_cast<int>(poses.size()) < count) {
    const double tilt = random.uniform(0, from_deg(20)), azimuth = random.uniform(0, 2 * M_PI);
    const Vec3 shift = uniform_vec3(random, 0.05);
    const Mat3 R = exp_rotation(tilt * Vec3(std::cos(azimuth), std::sin(azimuth), 0));
    const Pose X = make_pose(R, Vec3(m.X_BT_home.translation() + shift));
    violations.clear();
    kinematics::check(m.hexapod().geometry, m.hexapod().joints, m.hexapod().limits, X, violations);
    if (violations.empty()) poses.push_back(X);
  }
  return poses;
}

kinematics::HexapodGeometry built(const MachineDescription& m, const ToleranceSet& set, std::uint64_t seed) {
  Random random(seed, "as-built geometry of the tolerance test");
  kinematics::HexapodGeometry g = m.hexapod().geometry;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      g.base_joint[i][axis] += set.joint_position * random.normal();
      g.platform_joint[i][axis] += set.joint_position * random.normal();
    }
    g.length_offset[i] += set.length_offset * random.normal();
  }
  return g;
}

double share_below(const std::vector<double>& values, double limit) {
  const auto below = std::count_if(values.begin(), values.end(), [&](double v) { return v < limit; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

Vec3 tip_error(const MachineDescription& m, const kinematics::HexapodGeometry& truth, const Pose& X_BT) {
  kinematics::StrutLengths lengths;
  EXPECT_EQ(kinematics::inverse(m.hexapod().geometry, X_BT, lengths), kinematics::SolveStatus::ok);
  // The drive's displacement is length - l_i0 of the controller; the built strut adds its own l_i0.
  for (std::size_t i = 0; i < lengths.size(); ++i)
    lengths[i] += truth.length_offset[i] - m.hexapod().geometry.length_offset[i];
  const auto result = kinematics::forward(truth, lengths, X_BT);
  EXPECT_EQ(result.status, kinematics::SolveStatus::ok);
  return result.X_BT.translation() - X_BT.translation();
}

/// The tip error of each of many machines.
std::vector<double> tip_errors(const MachineDescription& m, const ToleranceSet& set, int machines,
                               int pose_count) {
  const std::vector<Pose> poses = workspace_poses(m, pose_count);
  std::vector<double> errors;
  for (int seed = 1; seed <= machines; ++seed) {
    const auto truth = built(m, set, static_cast<std::uint64_t>(seed));
    double sum = 0;
    for (const Pose& X : poses) sum += tip_error(m, truth, X).squaredNorm();
    errors.push_back(std::sqrt(sum / pose_count));
  }
  return errors;
}

TEST(Tolerances, ScatterOfTheHomeTipFollowsFromTheJacobian) {
  const auto m = load_machine("hexapod");
  const ToleranceSet set = m.tolerances.after_calibration;
  // l = sqrt(|d|^2 - dev^2): each strut's length scatters by 2 sigma_joint^2 |d|^2 / l^2 + sigma_offset^2,
  // and the tip by J^-1 times that times J^-T.
  Mat6 J;
  ASSERT_EQ(kinematics::jacobian(m.hexapod().geometry, m.X_BT_home, J), kinematics::SolveStatus::ok);
  kinematics::StrutLengths lengths;
  ASSERT_EQ(kinematics::inverse(m.hexapod().geometry, m.X_BT_home, lengths), kinematics::SolveStatus::ok);
  const double l2 = lengths[0] * lengths[0],
               d2 = l2 + m.hexapod().geometry.deviation * m.hexapod().geometry.deviation;
  const double variance =
      2 * set.joint_position * set.joint_position * d2 / l2 + set.length_offset * set.length_offset;
  const Mat6 inverse = J.inverse();
  const Mat6 covariance = variance * inverse * inverse.transpose();

  constexpr int kMachines = 4000;
  Vec3 sum = Vec3::Zero();
  for (int seed = 1; seed <= kMachines; ++seed)
    sum += tip_error(m, built(m, set, static_cast<std::uint64_t>(seed)), m.X_BT_home).cwiseAbs2();
  // A variance from 4000 samples has a standard error of sqrt(2 / 4000) = 2.2 %: 4 of them.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(sum[axis] / kMachines / covariance(axis, axis), 1, 0.09) << "axis " << axis;
}

TEST(Tolerances, CalibratedMachinesStayUnderHalfAMillimetre) {
  const auto m = load_machine("hexapod");
  // 150 machines: 95 % +- 2 standard errors of 1.8 %.
  EXPECT_GE(share_below(tip_errors(m, m.tolerances.after_calibration, 150, 60), 0.5e-3), 0.914);
}

TEST(SlowTolerances, NinetyFivePercentOfCalibratedMachinesStayUnderHalfAMillimetre) {
  const auto m = load_machine("hexapod");
  const auto errors = tip_errors(m, m.tolerances.after_calibration, 2000, 300);
  RecordProperty("percentile95_um", static_cast<int>(to_um(quantile(errors, 0.95))));
  // 2000 machines: standard error 0.5 %. Not above 98 % either: the set must not be kinder than the paper.
  EXPECT_GE(share_below(errors, 0.5e-3), 0.95);
  EXPECT_LE(share_below(errors, 0.5e-3), 0.98);
}

TEST(SlowTolerances, UncalibratedMachinesMissByMillimetres) {
  const auto m = load_machine("hexapod");
  const auto errors = tip_errors(m, m.tolerances.manufactured, 1000, 200);
  RecordProperty("median_um", static_cast<int>(to_um(quantile(errors, 0.5))));
  // docs/reference.md#calibration-figures saw 1.4 mm on one machine of this geometry: an ordinary draw of
  // this set.
  EXPECT_LT(quantile(errors, 0.05), 1.4e-3);
  EXPECT_GT(quantile(errors, 0.95), 1.4e-3);
  EXPECT_GT(share_below(errors, 5e-3) - share_below(errors, 1e-3), 0.8);
}

}  // namespace
}  // namespace understudy::machine
