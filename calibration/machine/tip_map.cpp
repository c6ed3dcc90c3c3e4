#include "calibration/machine/tip_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/bound.h"
#include "calibration/pose_choice.h"
#include "core/error.h"
#include "core/quantile.h"

namespace understudy::calibration {
namespace {

constexpr std::size_t kPoses = 400;   // their median is known within 3 %
constexpr double kSliceHalf = 50e-3;  // [m], half the cube of docs/reference.md#calibration-figures
constexpr double kSliceStep = 5e-3;   // [m]
constexpr const char* kAsked = "where the tip goes";
constexpr std::uint64_t kSeed = 1;  // the same poses for every calibration of a machine

/// sqrt of the trace: 1 sigma of the tip's 3D error.
double sigma_of(const Mat3& covariance) { return std::sqrt(std::max(0.0, covariance.trace())); }

/// How far the tip goes astray at a pose when `after` is the truth and `before` was believed.
bool moved_tip(const machine::MachineDescription& before, const kinematics::Mechanism& old_model,
               const machine::MachineDescription& after, const kinematics::Mechanism& new_model,
               const Pose& X_BT, double& distance) {
  kinematics::AxisVector axes{};
  const auto n = static_cast<std::size_t>(old_model.axis_count());
  if (old_model.inverse(X_BT, {}, std::span(axes).first(n)) != kinematics::SolveStatus::ok) return false;
  const auto old_zero = before.drive_zero(), new_zero = after.drive_zero();
  for (std::size_t i = 0; i < n; ++i) axes[i] += new_zero[i] - old_zero[i];
  Pose reached;
  if (new_model.forward(std::span(axes).first(n), X_BT, reached) != kinematics::SolveStatus::ok) return false;
  distance = (reached.translation() - X_BT.translation()).norm();
  return true;
}

bool reachable(const kinematics::Mechanism& mechanism, const Pose& X_BT) {
  kinematics::AxisVector axes{};
  const auto used = std::span(axes).first(static_cast<std::size_t>(mechanism.axis_count()));
  if (mechanism.inverse(X_BT, {}, used) != kinematics::SolveStatus::ok) return false;
  std::vector<kinematics::LimitViolation> violations;
  mechanism.check(X_BT, used, violations);
  return violations.empty();
}

TipMap::Slice slice(const machine::MachineDescription& machine, const kinematics::Mechanism& mechanism,
                    const TipCovariance& covariance, int v, const Progress& progress) {
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  TipMap::Slice out;
  out.v = "xyz"[v];
  out.step = kSliceStep;
  out.u0 = X_WT_home.translation().x() - kSliceHalf;
  out.v0 = X_WT_home.translation()[v] - kSliceHalf;
  out.columns = out.rows = 1 + static_cast<int>(std::lround(2 * kSliceHalf / kSliceStep));
  for (int row = 0; row < out.rows; ++row) {
    tell(progress, static_cast<std::size_t>(row), static_cast<std::size_t>(out.rows), kAsked);
    for (int column = 0; column < out.columns; ++column) {
      Pose X_WT = X_WT_home;
      X_WT.translation().x() = out.u0 + column * out.step;
      X_WT.translation()[v] = out.v0 + row * out.step;
      const Pose X_BT = machine.X_WB.inverse() * X_WT;
      Mat3 at;
      const bool known = reachable(mechanism, X_BT) && covariance(X_BT, at);
      out.sigma.push_back(known ? sigma_of(at) : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return out;
}

std::vector<Pose> poses_of_work_space(const machine::MachineDescription& machine,
                                      const kinematics::Mechanism& mechanism) {
  Random random(kSeed, "calibrate work space");
  try {
    return random_reachable_poses(mechanism, reference_region(machine.X_BT_home), kPoses, random);
  } catch (const InputError&) {
    throw InputError(
        "the calibrated machine reaches hardly any pose of its work space: not all that was measured "
        "belongs to one machine; look for a wrong pose, or try --estimator robust");
  }
}

}  // namespace

TipMap tip_map(const machine::MachineDescription& before, const machine::MachineDescription& after,
               const TipCovariance& covariance, const Progress& progress) {
  tell(progress, 0, 1, kAsked);
  const auto old_model = before.make_mechanism(), new_model = after.make_mechanism();
  TipMap map;
  std::vector<double> sigmas, moves;
  double squares = 0;
  std::size_t done = 0;
  for (const Pose& X_BT : poses_of_work_space(after, *new_model)) {
    if (double d = 0; moved_tip(before, *old_model, after, *new_model, X_BT, d)) moves.push_back(d);
    tell(stage_of(progress, 0, 0.4), ++done, kPoses, kAsked);
    Mat3 at;
    if (!covariance || !covariance(X_BT, at)) continue;
    sigmas.push_back(sigma_of(at));
    squares += at.trace();
  }
  map.moved_median = quantile(moves, 0.5);
  map.moved_worst = quantile(moves, 1);
  map.poses = static_cast<int>(sigmas.size());
  map.median = quantile(sigmas, 0.5);
  map.worst = quantile(sigmas, 1);
  map.rms = std::sqrt(squares / static_cast<double>(sigmas.size()));
  if (sigmas.empty()) return map;
  for (const int v : {1, 2})
    map.slices.push_back(
        slice(after, *new_model, covariance, v, stage_of(progress, v == 1 ? 0.4 : 0.7, v == 1 ? 0.7 : 1)));
  return map;
}

TipCovariance hexapod_tip(const machine::MachineDescription& machine, const Calibration& calibration,
                          const Unknowns& unknowns) {
  HexapodParameters parameters{machine.hexapod().geometry, {}};
  return [parameters, covariance = calibration.covariance, unknowns](const Pose& X_BT, Mat3& at) {
    const auto tip = tip_uncertainty(parameters, covariance, unknowns, std::span(&X_BT, 1));
    if (tip.covariances.empty()) return false;
    at = tip.covariances.front();
    return true;
  };
}

TipCovariance in_frame(const TipCovariance& covariance, const MeasuringFrame& frame, const Vec3& middle_W,
                       const Pose& X_WB) {
  return [covariance, X_WB, middle_W, frame](const Pose& X_BT, Mat3& at) {
    if (!covariance(X_BT, at)) return false;
    const Mat3 R_BW = X_WB.linear().transpose();
    at += R_BW * frame.covariance(X_WB * X_BT.translation() - middle_W) * R_BW.transpose();
    return true;
  };
}

TipCovariance chain_tip(const machine::MachineDescription& machine, const ChainCalibration& calibration) {
  const auto names = chain_parameter_names(calibration.parameters.chain);
  std::vector<Eigen::Index> kept;
  for (const std::string& name : calibration.estimated)
    kept.push_back(std::find(names.begin(), names.end(), name) - names.begin());
  const std::shared_ptr<kinematics::Mechanism> mechanism = machine.make_mechanism();
  return [mechanism, kept, parameters = calibration.parameters, covariance = calibration.covariance](
             const Pose& X_BT, Mat3& at) {
    std::vector<double> axes(static_cast<std::size_t>(mechanism->axis_count()));
    if (mechanism->inverse(X_BT, {}, axes) != kinematics::SolveStatus::ok) return false;
    const Eigen::MatrixXd rows = chain_rows(parameters, axes)(Eigen::seqN(0, 3), kept);
    at = rows * covariance * rows.transpose();
    return true;
  };
}

}  // namespace understudy::calibration
