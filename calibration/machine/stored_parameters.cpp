#include "calibration/machine/stored_parameters.h"

#include <algorithm>

#include "calibration/absorb_zeros.h"
#include "calibration/machine/estimation_report.h"
#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

constexpr Eigen::Index kDeviationRow = kGeometryParameters;
constexpr Eigen::Index kWorkRow = 6;  // after the tool's position and rotation

/// Of the motion (p + t + w x p, exp(w) R), told in B, that the measuring frame makes of every pose.
Mat6 frame_covariance(const Measurements& measurements, const machine::MachineDescription& machine) {
  const MeasuringFrame frame = measurements.frame.value_or(MeasuringFrame{});
  const Vec3 middle_B = machine.X_WB.inverse() * middle_of_tips(measurements);
  Mat6 by_motion = Mat6::Identity();  // t = shift - w x middle
  by_motion.topRightCorner<3, 3>() = cross_matrix(middle_B);
  Mat6 variance = Mat6::Zero();
  variance.diagonal().head<3>().setConstant(frame.position * frame.position);
  variance.diagonal().tail<3>().setConstant(frame.rotation * frame.rotation);
  return by_motion * variance * by_motion.transpose();
}

/// How far the file's numbers of `to` are from those of `from`, in the order of CalibratedParameters.
Eigen::VectorXd change(const kinematics::Chain& from, const kinematics::Chain& to, Eigen::Index rows) {
  Eigen::VectorXd by(rows);
  Eigen::Index row = 0;
  const auto add = [&](const Vec3& v) {
    by.segment<3>(row) = v;
    row += 3;
  };
  for (const auto mount : {&kinematics::Chain::X_OT_zero, &kinematics::Chain::X_OS_zero}) {
    add((to.*mount).translation() - (from.*mount).translation());
    add(log_rotation((to.*mount).linear() * (from.*mount).linear().transpose()));
  }
  for (std::size_t i = 0; i < from.axes.size(); ++i) {
    add(to.axes[i].direction - from.axes[i].direction);
    if (from.axes[i].angle) add(to.axes[i].point - from.axes[i].point);
  }
  return by;
}

/// d (the file's numbers) / d (the estimated parameters).
Eigen::MatrixXd by_estimated(const ChainCalibration& found, Eigen::Index rows) {
  constexpr double kStep = 1e-6;  // [m] or [rad]: of central differences, whose error is its square
  const auto names = chain_parameter_names(found.parameters.chain);
  const kinematics::Chain base = absorb_zeros(found.parameters);
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(found.estimated.size()));
  for (std::size_t k = 0; k < found.estimated.size(); ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
    step[std::find(names.begin(), names.end(), found.estimated[k]) - names.begin()] = kStep;
    const auto moved_by = [&](const Eigen::VectorXd& by) {
      return change(base, absorb_zeros(moved(found.parameters, by)), rows);
    };
    columns.col(static_cast<Eigen::Index>(k)) = (moved_by(step) - moved_by(-step)) / (2 * kStep);
  }
  return columns;
}

}  // namespace

machine::CalibratedParameters stored_parameters(const Calibration& found, const Unknowns& unknowns,
                                                const Measurements& measurements,
                                                const machine::MachineDescription& machine) {
  machine::CalibratedParameters stored;
  if (unknowns.play) stored.play = found.parameters.play;
  if (found.covariance.size() == 0) return stored;
  const Eigen::Index rows = machine::calibrated_units(machine, unknowns.play).size();
  std::vector<Eigen::Index> row_of;  // of each unknown
  for (Eigen::Index k = 0; k < rows; ++k)
    if (k != kDeviationRow || unknowns.deviation) row_of.push_back(k);
  stored.covariance = Eigen::MatrixXd::Zero(rows, rows);
  stored.covariance(row_of, row_of) = found.covariance;
  Eigen::MatrixXd by_frame = Eigen::MatrixXd::Zero(rows, 6);
  for (std::size_t i = 0; i < kStruts; ++i) {
    const Eigen::Index row = kStrutParameters * static_cast<Eigen::Index>(i);
    by_frame.block<3, 3>(row, 0).setIdentity();
    by_frame.block<3, 3>(row, 3) = -cross_matrix(found.parameters.geometry.base_joint[i]);
  }
  stored.covariance += by_frame * frame_covariance(measurements, machine) * by_frame.transpose();
  return stored;
}

machine::CalibratedParameters stored_parameters(const ChainCalibration& found,
                                                const Measurements& measurements,
                                                const machine::MachineDescription& machine) {
  machine::CalibratedParameters stored;
  if (found.covariance.size() == 0) return stored;
  const Eigen::Index rows = machine::calibrated_units(machine, false).size();
  const Eigen::MatrixXd columns = by_estimated(found, rows);
  stored.covariance = columns * found.covariance * columns.transpose();
  // What is seen from a frame that has moved by (t, w) stands at X_OS (t, w)^-1.
  const Mat3 R_OS = absorb_zeros(found.parameters).X_OS_zero.linear();
  Mat6 by_frame = Mat6::Zero();
  by_frame.topLeftCorner<3, 3>() = by_frame.bottomRightCorner<3, 3>() = -R_OS;
  stored.covariance.block<6, 6>(kWorkRow, kWorkRow) +=
      by_frame * frame_covariance(measurements, machine) * by_frame.transpose();
  // Products of matrices round each side of the diagonal by itself.
  stored.covariance = 0.5 * (stored.covariance + stored.covariance.transpose()).eval();
  return stored;
}

}  // namespace understudy::calibration
