#include "calibration/synthetic.h"

#include <Eigen/Cholesky>

namespace understudy::calibration {

Mat6 MeasurementNoise::covariance() const {
  Eigen::Matrix<double, 6, 1> variance;
  variance << Vec3::Constant(position * position), Vec3::Constant(rotation * rotation);
  return variance.asDiagonal();
}

HexapodGeometry perturbed(const HexapodGeometry& nominal, double sigma, Random& random) {
  HexapodGeometry built = nominal;
  for (std::size_t i = 0; i < kStruts; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) built.base_joint[i][k] += sigma * random.normal();
    for (Eigen::Index k = 0; k < 3; ++k) built.platform_joint[i][k] += sigma * random.normal();
    built.length_offset[i] += sigma * random.normal();
  }
  return built;
}

bool true_sample(const HexapodParameters& truth, const HexapodGeometry& nominal, const Pose& X_BT_asked,
                 const MeasurementNoise& noise, const kinematics::PerStrut<Approach>& approach,
                 PoseSample& sample) {
  StrutLengths lengths;
  if (kinematics::inverse(nominal, X_BT_asked, lengths) != kinematics::SolveStatus::ok) return false;
  sample.displacement = displacements(nominal, lengths);
  sample.approach = approach;
  sample.covariance = noise.covariance();
  const auto reached = kinematics::forward(truth.geometry, strut_lengths(truth, sample), X_BT_asked);
  if (reached.status != kinematics::SolveStatus::ok) return false;
  sample.X_BT = reached.X_BT;
  return true;
}

PoseSample measured(const PoseSample& true_sample, Random& random) {
  Twist unit;
  for (Eigen::Index k = 0; k < 6; ++k) unit[k] = random.normal();
  const Twist e = true_sample.covariance.llt().matrixL() * unit;
  PoseSample sample = true_sample;
  sample.X_BT = make_pose(Mat3(exp_rotation(e.tail<3>()) * sample.X_BT.linear()),
                          sample.X_BT.translation() + e.head<3>());
  return sample;
}

}  // namespace understudy::calibration
