#include "calibration/machine/calibrate_chain.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/absorb_zeros.h"
#include "calibration/calibrated.h"
#include "calibration/machine/estimation_report.h"
#include "calibration/machine/stored_parameters.h"
#include "calibration/machine/tip_map.h"
#include "core/error.h"
#include "core/error_context.h"
#include "core/units.h"
#include "machine/file/calibration_section.h"

namespace understudy::calibration {
namespace {

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
  const auto names = chain_parameter_names(drawn.chain);
  const auto values = changes(drawn, found.parameters);
  std::vector<ParameterLine> lines;
  for (std::size_t k = 0; k < found.estimated.size(); ++k) {
    const std::string& name = found.estimated[k];
    const bool angle = is_angle(name, drawn.chain);
    const double unit = angle ? kDegree : kMillimetre;
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    lines.push_back({name, angle ? "deg" : "mm", 0, values[at] / unit, sigma_of(found.covariance, k) / unit});
  }
  return lines;
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

TipCovariance tip_covariance(const MachineCalibration& result, const ChainCalibration& found,
                             const Measurements& measurements) {
  if (found.covariance.size() == 0) return {};
  TipCovariance tip = chain_tip(result.machine, found);
  if (!measurements.frame) return tip;
  return in_frame(tip, *measurements.frame, middle_of_tips(measurements), result.machine.X_WB);
}

}  // namespace

void calibrate_chain_machine(const Measurements& measurements, const machine::MachineDescription& nominal,
                             const Estimator& estimator, MachineCalibration& result,
                             const Progress& progress) {
  machine::require_calibratable(nominal);
  check_axes_moved(measurements, nominal);
  const ChainProblem problem{{nominal.chain().kinematics.chain, {}}, chain_samples(measurements, nominal)};
  const ChainCalibration found = estimator.calibrate_chain(problem, {.progress = stage_of(progress, 0, 0.7)});
  check_found(found, measurements, result.estimator);
  kinematics::ChainDescription& known = result.machine.chain().kinematics;
  if (known.design.axes.empty()) known.design = known.chain;
  known.chain = absorb_zeros(found.parameters);
  result.stored = stored_parameters(found, measurements, result.machine);
  result.machine.X_BT_home = kinematics::forward(known.chain, known.home);
  for (std::size_t j = 0; j < problem.samples.size(); ++j) {
    const ChainSample& sample = problem.samples[j];
    PoseResidual r = pose_residual(found, sample.covariance, j, measurements.poses[j].line);
    r.before = pose_error(sample.X_ST, forward(problem.nominal, sample.axes));
    result.poses.push_back(r);
  }
  result.parameters = parameter_lines(problem.nominal, found);
  result.redundant = found.redundant;
  report_estimation(found, found.covariance, result);
  const std::string misfit =
      misfit_warning(found.chi_square, found.degrees_of_freedom, "outliers, play, bending");
  if (!misfit.empty()) result.warnings.push_back(misfit);
  result.tip = in_context_of(measurements.file, [&] {
    return tip_map(nominal, result.machine, tip_covariance(result, found, measurements),
                   stage_of(progress, 0.7, 1));
  });
}

}  // namespace understudy::calibration
