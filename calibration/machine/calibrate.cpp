#include "calibration/machine/calibrate.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/calibrated.h"
#include "calibration/machine/calibrate_chain.h"
#include "calibration/machine/calibrate_tip.h"
#include "calibration/residual_covariance.h"
#include "calibration/strut_model.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using calibration::Calibration;
using calibration::Problem;
using calibration::Unknowns;

constexpr const char* kDefault = "maximum_likelihood";

PoseResidual residual_of(const Problem& problem, const Calibration& found, std::size_t j, int line) {
  const calibration::PoseSample& sample = problem.samples[j];
  PoseResidual r;
  r.line = line;
  r.used = found.used[j];
  r.after = found.residuals[j];
  r.whitened = sample.covariance.llt().matrixL().solve(r.after);
  const auto reached = kinematics::forward(problem.nominal.geometry,
                                           calibration::strut_lengths(problem.nominal, sample), sample.X_BT);
  r.before = calibration::pose_error(sample.X_BT, reached.X_BT);
  calibration::StrutLinearisation at;
  if (!calibration::linearise(found.parameters, sample, sample.X_BT, at)) return r;
  const Mat6 covariance = calibration::residual_covariance(at, sample);
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
    const auto k = static_cast<Eigen::Index>(lines.size());
    lines.push_back({name, word, before / unit, after / unit, std::sqrt(found.covariance(k, k)) / unit});
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

/// Advice about "pose 7" belongs to a line of the file.
[[noreturn]] void refuse(const Measurements& measurements, const std::string& message) {
  std::size_t number = 0;
  int line = 0;
  if (std::sscanf(message.c_str(), "pose %zu:", &number) == 1 && number >= 1 &&
      number <= measurements.poses.size())
    line = measurements.poses[number - 1].line;
  throw InputError({measurements.file, line, 0}, message);
}

void check_model(const machine::MachineDescription& machine, const Measurements& measurements,
                 CalibrateResult& result) {
  if (machine.hexapod().screw_rotation == machine::ScrewRotation::compensated)
    throw InputError(
        {measurements.file, 0, 0},
        "struts of a machine with screw_rotation compensated turn in their nuts: their drives do "
        "not tell lengths, which the estimators need");
  if (machine.hexapod().screw_rotation == machine::ScrewRotation::free)
    result.warnings.emplace_back(
        "screw_rotation is free: turning screws change the lengths, which no estimator models");
}

void calibrate_hexapod(const Measurements& measurements, const machine::MachineDescription& nominal,
                       CalibrateResult& result) {
  check_model(nominal, measurements, result);
  const auto estimator = calibration::make_estimator(result.estimator);
  const Unknowns unknowns = estimator->unknowns();
  if (unknowns.play && !measurements.approach_told)
    throw InputError(
        {measurements.file, 0, 0},
        fmt::format("{} needs the columns a1..a6: the side that each strut came from", result.estimator));
  const Problem problem = hexapod_problem(measurements, nominal);
  const Calibration found = estimator->calibrate(problem);
  if (!found.ok()) refuse(measurements, found.message);
  result.machine.hexapod().geometry = found.parameters.geometry;
  for (std::size_t j = 0; j < problem.samples.size(); ++j)
    result.poses.push_back(residual_of(problem, found, j, measurements.poses[j].line));
  result.parameters = parameter_lines(problem, found, unknowns);
  const Eigen::VectorXd scale = found.covariance.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd correlation = scale.asDiagonal() * found.covariance * scale.asDiagonal();
  correlation.diagonal().setZero();
  result.correlation_max = correlation.cwiseAbs().maxCoeff();
  result.chi_square = found.chi_square;
  result.degrees_of_freedom = found.degrees_of_freedom;
  result.iterations = found.iterations;
  result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
  result.tip = tip_map(nominal, result.machine,
                       in_frame(hexapod_tip(result.machine, found, unknowns), measurements, nominal.X_WB));
}

std::string line_list(const CalibrateResult& result) {
  std::vector<int> lines;
  for (const PoseResidual& pose : result.poses)
    if (!pose.used) lines.push_back(pose.line);
  return fmt::format("{}", fmt::join(lines, ", "));
}

}  // namespace

CalibrateResult calibrate(const CalibrateRequest& request) {
  CalibrateResult result;
  result.file = request.measurements;
  result.command = request.command;
  result.estimator = request.estimator.empty() ? kDefault : request.estimator;
  calibration::make_estimator(result.estimator);  // a wrong name before anything else
  result.noise = request.noise.value_or(calibration::kReferenceNoise);
  const machine::MachineDescription nominal = machine::load_machine(request.machine);
  const Measurements measurements = read_measurements(request.measurements, nominal, result.noise);
  result.noise_given = measurements.noise_given;
  result.frame = measurements.frame;
  result.machine = nominal;
  if (!measurements.noise_given && !request.noise)
    result.warnings.push_back(
        fmt::format("the file does not tell the noise of its poses: {:g} um and {:g} mrad "
                    "on each axis are assumed (--noise)",
                    to_um(result.noise.position), 1e3 * result.noise.rotation));
  if (nominal.chain)
    calibrate_chain_machine(measurements, nominal, result);
  else
    calibrate_hexapod(measurements, nominal, result);
  if (const std::string lines = line_list(result); !lines.empty())
    result.warnings.push_back("poses rejected as outliers: line " + lines);
  result.machine.calibration = {
      result.estimator, std::filesystem::path(request.measurements).filename().string(), measurements.sha256,
      static_cast<int>(measurements.poses.size()), result.tip.rms};
  return result;
}

double residual_rms(const CalibrateResult& result, bool before) {
  double sum = 0;
  int count = 0;
  for (const PoseResidual& pose : result.poses) {
    if (!pose.used) continue;
    sum += (before ? pose.before : pose.after).head<3>().squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace understudy::rehearsal
