#include "calibration/machine/calibrate_chain.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/calibrated.h"
#include "calibration/machine/calibrate_tip.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using calibration::ChainCalibration;
using calibration::ChainParameters;

/// How far every listed parameter of `found` is from `drawn`, in the order of chain_parameter_names().
std::vector<double> changes(const ChainParameters& drawn, const ChainParameters& found) {
  std::vector<double> values;
  for (std::size_t i = 0; i < drawn.chain.axes.size(); ++i) {
    const auto& from = drawn.chain.axes[i];
    const auto& to = found.chain.axes[i];
    const Vec3 u = from.direction.unitOrthogonal(), v = from.direction.cross(u);
    // d + (a u + b v) x d = d - a v + b u
    values.insert(values.end(), {found.zero[i], -to.direction.dot(v), to.direction.dot(u)});
    if (from.angle)
      values.insert(values.end(), {(to.point - from.point).dot(u), (to.point - from.point).dot(v)});
  }
  for (const auto& [from, to] : {std::pair(drawn.chain.X_OT_zero, found.chain.X_OT_zero),
                                 std::pair(drawn.chain.X_OS_zero, found.chain.X_OS_zero)}) {
    const Pose by = from.inverse() * to;
    const Vec3 p = by.translation(), w = log_rotation(by.linear());
    values.insert(values.end(), {p.x(), p.y(), p.z(), w.x(), w.y(), w.z()});
  }
  return values;
}

bool is_angle(const std::string& name, const kinematics::Chain& chain) {
  if (name.find("turn") != std::string::npos || name.find("tilt") != std::string::npos) return true;
  for (const auto& axis : chain.axes)
    if (name == axis.name + " zero") return axis.angle;
  return false;
}

std::vector<ParameterLine> parameter_lines(const ChainParameters& drawn, const ChainCalibration& found) {
  const auto names = calibration::chain_parameter_names(drawn.chain);
  const auto values = changes(drawn, found.parameters);
  std::vector<ParameterLine> lines;
  for (std::size_t k = 0; k < found.estimated.size(); ++k) {
    const std::string& name = found.estimated[k];
    const bool angle = is_angle(name, drawn.chain);
    const double unit = angle ? kDegree : kMillimetre;
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const auto row = static_cast<Eigen::Index>(k);
    lines.push_back(
        {name, angle ? "deg" : "mm", 0, values[at] / unit, std::sqrt(found.covariance(row, row)) / unit});
  }
  return lines;
}

void check_rank(const Measurements& measurements, const ChainCalibration& found) {
  if (found.ok()) return;
  std::size_t number = 0;
  int line = 0;
  if (std::sscanf(found.message.c_str(), "pose %zu:", &number) == 1 && number >= 1 &&
      number <= measurements.poses.size())
    line = measurements.poses[number - 1].line;
  throw InputError({measurements.file, line, 0}, found.message);
}

/// An axis that stood still, named: the rank alone does not say which.
void check_axes_moved(const Measurements& measurements, const machine::MachineDescription& machine) {
  const auto& axes = machine.chain().kinematics.chain.axes;
  constexpr double kStill = 1e-6;  // [m], [rad]
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto [low, high] = std::minmax_element(
        measurements.poses.begin(), measurements.poses.end(),
        [i](const MeasuredPose& a, const MeasuredPose& b) { return a.axes[i] < b.axes[i]; });
    if (measurements.poses.size() > 1 && high->axes[i] - low->axes[i] < kStill)
      throw InputError({measurements.file, 0, 0},
                       fmt::format("axis {} never moves: its line and zero cannot be told", axes[i].name));
  }
}

}  // namespace

void calibrate_chain_machine(const Measurements& measurements, const machine::MachineDescription& nominal,
                             CalibrateResult& result) {
  const bool robust = result.estimator == "robust";
  if (!robust && result.estimator != "maximum_likelihood")
    throw InputError(fmt::format(
        "estimator {} is for hexapods; an open chain has maximum_likelihood and robust", result.estimator));
  if (nominal.mechanism != "arm" && nominal.mechanism != "chain")
    throw InputError(
        fmt::format("a calibrated '{}' would have no inverse kinematics: only hexapod, arm and "
                    "chain can be calibrated",
                    nominal.mechanism));
  check_axes_moved(measurements, nominal);
  const ChainParameters drawn{nominal.chain().kinematics.chain, {}};
  const auto samples = chain_samples(measurements, nominal);
  const ChainCalibration found = robust ? calibration::calibrate_chain_robust(drawn, samples)
                                        : calibration::calibrate_chain(drawn, samples);
  check_rank(measurements, found);
  kinematics::ChainDescription& known = result.machine.chain().kinematics;
  if (known.design.axes.empty()) known.design = known.chain;
  known.chain = zeros_absorbed(found.parameters);
  result.machine.X_BT_home = kinematics::forward(known.chain, known.home);
  for (std::size_t j = 0; j < samples.size(); ++j) {
    PoseResidual r;
    r.line = measurements.poses[j].line;
    r.used = found.used[j];
    r.before = calibration::pose_error(samples[j].X_ST, calibration::forward(drawn, samples[j].axes));
    r.after = found.residuals[j];
    r.whitened = samples[j].covariance.llt().matrixL().solve(r.after);
    result.poses.push_back(r);
  }
  result.parameters = parameter_lines(drawn, found);
  result.redundant = found.redundant;
  const Eigen::VectorXd scale = found.covariance.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd correlation = scale.asDiagonal() * found.covariance * scale.asDiagonal();
  correlation.diagonal().setZero();
  result.correlation_max = correlation.cwiseAbs().maxCoeff();
  result.chi_square = found.chi_square;
  result.degrees_of_freedom = found.degrees_of_freedom;
  result.iterations = found.iterations;
  result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
  const std::string misfit =
      calibration::misfit_warning(found.chi_square, found.degrees_of_freedom, "outliers, play, bending");
  if (!misfit.empty()) result.warnings.push_back(misfit);
  result.tip = tip_map(nominal, result.machine,
                       in_frame(chain_tip(result.machine, found), measurements, nominal.X_WB));
}

}  // namespace understudy::rehearsal
