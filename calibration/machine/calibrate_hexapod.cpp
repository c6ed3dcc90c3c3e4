#include "calibration/machine/calibrate_hexapod.h"

#include <cmath>

#include <fmt/format.h>

#include "calibration/calibrated.h"
#include "calibration/machine/calibrate_by_loads.h"
#include "calibration/machine/estimation_report.h"
#include "calibration/machine/stored_parameters.h"
#include "calibration/machine/tip_map.h"
#include "calibration/residual_covariance.h"
#include "core/error.h"
#include "core/error_context.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

constexpr const char* kTip = "where the tip goes";

PoseResidual residual_of(const Problem& problem, const Calibration& found, std::size_t j, int line) {
  const PoseSample& sample = problem.samples[j];
  PoseResidual r = pose_residual(found, sample.covariance, j, line);
  const auto reached =
      kinematics::forward(problem.nominal.geometry, strut_lengths(problem.nominal, sample), sample.X_BT);
  r.before = pose_error(sample.X_BT, reached.X_BT);
  StrutLinearisation at;
  if (!linearise(found.parameters, sample, sample.X_BT, at)) return r;
  const Mat6 covariance = residual_covariance(at, sample);
  for (Eigen::Index i = 0; i < 6; ++i) {
    r.strut.push_back(at.residual[i]);
    r.strut_sigma.push_back(std::sqrt(covariance(i, i)));
  }
  return r;
}

std::vector<ParameterLine> parameter_lines(const Problem& problem, const Calibration& found,
                                           const Unknowns& unknowns) {
  std::vector<ParameterLine> lines;
  const auto add = [&](const std::string& name, double before, double after, double unit, const char* word) {
    lines.push_back(
        {name, word, before / unit, after / unit, sigma_of(found.covariance, lines.size()) / unit});
  };
  const auto& old_one = problem.nominal;
  const auto& new_one = found.parameters;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k)
      add(fmt::format("base joint {} {}", i + 1, "xyz"[k]), old_one.geometry.base_joint[i][k],
          new_one.geometry.base_joint[i][k], kMillimetre, "mm");
    for (Eigen::Index k = 0; k < 3; ++k)
      add(fmt::format("platform joint {} {}", i + 1, "xyz"[k]), old_one.geometry.platform_joint[i][k],
          new_one.geometry.platform_joint[i][k], kMillimetre, "mm");
    add(fmt::format("length offset {}", i + 1), old_one.geometry.length_offset[i],
        new_one.geometry.length_offset[i], kMillimetre, "mm");
  }
  if (unknowns.deviation)
    add("deviation", old_one.geometry.deviation, new_one.geometry.deviation, kMillimetre, "mm");
  for (std::size_t i = 0; unknowns.play && i < kinematics::kStruts; ++i)
    add(fmt::format("play {}", i + 1), old_one.play[i], new_one.play[i], kMicrometre, "um");
  return lines;
}

TipCovariance tip_covariance(const MachineCalibration& result, const Calibration& found,
                             const Unknowns& unknowns, const Measurements& measurements) {
  if (found.covariance.size() == 0) return {};
  TipCovariance tip = hexapod_tip(result.machine, found, unknowns);
  if (!measurements.frame) return tip;
  return in_frame(tip, *measurements.frame, middle_of_tips(measurements), result.machine.X_WB);
}

}  // namespace

void check_hexapod_model(const machine::MachineDescription& machine, const std::string& file,
                         MachineCalibration& result) {
  if (machine.hexapod().screw_rotation == machine::ScrewRotation::compensated)
    throw InputError(
        {file, 0, 0},
        "struts of a machine with screw_rotation compensated turn in their nuts: their drives do "
        "not tell lengths, which the estimators need");
  if (machine.hexapod().screw_rotation == machine::ScrewRotation::free)
    result.warnings.emplace_back(
        "screw_rotation is free: turning screws change the lengths, which no estimator models");
}

void calibrate_hexapod(const Measurements& measurements, const machine::MachineDescription& nominal,
                       const Estimator& estimator, MachineCalibration& result, const Progress& progress) {
  check_hexapod_model(nominal, measurements.file, result);
  const Unknowns unknowns = estimator.unknowns();
  if (unknowns.play && !measurements.approach_told)
    throw InputError(
        {measurements.file, 0, 0},
        fmt::format("{} needs the columns a1..a6: the side that each strut came from", result.estimator));
  Problem problem = hexapod_problem(measurements, nominal);
  const Calibration found =
      calibrate_by_loads(nominal, estimator, problem, {.progress = stage_of(progress, 0, 0.9)});
  check_found(found, measurements, result.estimator);
  tell(progress, 9, 10, kTip);
  report_hexapod(problem, found, unknowns, measurements, nominal, result);
}

void report_hexapod(const Problem& problem, const Calibration& found, const Unknowns& unknowns,
                    const Measurements& measurements, const machine::MachineDescription& nominal,
                    MachineCalibration& result) {
  result.machine.hexapod().geometry = found.parameters.geometry;
  result.stored = stored_parameters(found, unknowns, measurements, result.machine);
  for (std::size_t j = 0; j < problem.samples.size(); ++j)
    result.poses.push_back(residual_of(problem, found, j, measurements.poses[j].line));
  result.parameters = parameter_lines(problem, found, unknowns);
  report_estimation(found, found.covariance, result);
  result.tip = in_context_of(measurements.file, [&] {
    return tip_map(nominal, result.machine, tip_covariance(result, found, unknowns, measurements));
  });
}

}  // namespace understudy::calibration
