// What can be seen in the samples without a Jacobian.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/identifiability.h"
#include "calibration/strut_model.h"
#include "core/units.h"
#include "kinematics/rigid_pose.h"

namespace understudy::calibration {
namespace {

constexpr double kLongest = 10;       // [m]; a longer strut or farther pose is in other units
constexpr double kStill = 1e-6;       // [m], far below any useful travel
constexpr double kWithinNoise = 5;    // standard deviations: the range of 100 normal numbers
constexpr double kStillAngle = 1e-5;  // [rad]

/// Positive definite to rounding: metres and radians are compared through their own variances.
bool usable_covariance(const Mat6& S) {
  if (!S.allFinite() || !(S.diagonal().minCoeff() > 0)) return false;
  const Vec6 scale = S.diagonal().cwiseSqrt().cwiseInverse();
  const Mat6 correlation = scale.asDiagonal() * S * scale.asDiagonal();
  constexpr double kSymmetric = 1e-6, kDefinite = 1e-10;
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kSymmetric) return false;
  const Eigen::LLT<Mat6> factors(correlation);
  return factors.info() == Eigen::Success &&
         factors.matrixLLT().diagonal().cwiseAbs2().minCoeff() > kDefinite;
}

double mean_sigma(const Problem& problem, Eigen::Index k) {
  double sum = 0;
  for (const PoseSample& sample : problem.samples) sum += sample.covariance(k, k);
  return std::sqrt(sum / static_cast<double>(problem.samples.size()));
}

template <class Value>
double range(const Problem& problem, Value value) {
  double low = value(problem.samples.front()), high = low;
  for (const PoseSample& sample : problem.samples) {
    low = std::min(low, value(sample));
    high = std::max(high, value(sample));
  }
  return high - low;
}

}  // namespace

Fault input_fault(const Problem& problem) {
  if (problem.samples.empty()) return {"there is no pose", {}};
  const HexapodParameters& nominal = problem.nominal;
  for (std::size_t j = 0; j < problem.samples.size(); ++j) {
    const PoseSample& sample = problem.samples[j];
    if (!kinematics::is_rigid(sample.X_BT))
      return fault_of_pose(j, "the measured pose is not finite and rigid");
    if (!(sample.X_BT.translation().norm() < kLongest))
      return fault_of_pose(j, "the measured tip is more than 10 m from the base: is it in metres?");
    if (!usable_covariance(sample.covariance))
      return fault_of_pose(j, "the covariance is not symmetric and positive definite");
    for (std::size_t i = 0; i < kStruts; ++i)
      if (!(std::abs(sample.displacement[i]) < kLongest)) {
        const std::string part = "the displacement of strut " + std::to_string(i + 1);
        return fault_of_pose(j, part + " is not a finite length below 10 m");
      }
    StrutLinearisation at;
    if (!linearise(nominal, sample, sample.X_BT, at))
      return fault_of_pose(j, "a strut of the nominal machine would be shorter than dev there");
  }
  return {};
}

std::string dead_measurement(const Problem& problem) {
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double travel = range(problem, [i](const PoseSample& s) { return s.displacement[i]; });
    if (travel > kStill) continue;
    return fmt::format(
        "strut {} reads the same displacement, {:.3f} mm, in all {} poses: connect its reading, or choose "
        "poses that "
        "move it",
        i + 1, to_mm(problem.samples.front().displacement[i]), problem.samples.size());
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double travel = range(problem, [k](const PoseSample& s) { return s.X_BT.translation()[k]; });
    const double noise = mean_sigma(problem, k);
    if (travel > std::max(kStill, kWithinNoise * noise)) continue;
    return fmt::format(
        "{0} of the measured poses changes by {1:.4f} mm in all, no more than its noise of {2:.4f} mm: check "
        "that "
        "measurement, or choose poses that differ in {0}",
        "xyz"[k], to_mm(travel), to_mm(noise));
  }
  return {};
}

std::string missing_rotation(const Problem& problem) {
  const Mat3 R_BT_first = problem.samples.front().X_BT.linear();
  Vec3 mean = Vec3::Zero();
  std::vector<Vec3> turns;
  for (const PoseSample& sample : problem.samples) {
    turns.push_back(log_rotation(sample.X_BT.linear() * R_BT_first.transpose()));
    mean += turns.back() / static_cast<double>(problem.samples.size());
  }
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& turn : turns) scatter += (turn - mean) * (turn - mean).transpose();
  scatter /= static_cast<double>(turns.size());
  const Eigen::SelfAdjointEigenSolver<Mat3> spread(scatter);
  double noise = 0;
  for (Eigen::Index k = 3; k < 6; ++k) noise = std::max(noise, mean_sigma(problem, k));
  const double still = std::max(kStillAngle, 2 * noise);  // RMS of noise alone is 1
  const auto turned = [&](Eigen::Index k) { return std::sqrt(std::max(0.0, spread.eigenvalues()[k])); };
  if (turned(2) < still) {
    return fmt::format(
        "no rotation: the orientations spread by {:.4f} deg RMS, so only 4 of the 7 parameters of each strut "
        "can be "
        "told; tilt the platform by 10 to 20 deg in several directions",
        to_deg(turned(2)));
  }
  if (turned(1) < still) {
    const Vec3 axis = spread.eigenvectors().col(2);
    return fmt::format(
        "no rotation but about the axis ({:.2f}, {:.2f}, {:.2f}), so 6 of the 7 parameters of each strut can "
        "be told; "
        "tilt the platform about a second axis as well",
        axis.x(), axis.y(), axis.z());
  }
  return {};
}

}  // namespace understudy::calibration
