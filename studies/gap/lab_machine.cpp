#include "studies/gap/lab_machine.h"

#include "calibration/estimators/estimator.h"
#include "calibration/gap_sensor/calibrate_gap_sensor.h"
#include "calibration/machine/calibrate_chain.h"
#include "calibration/machine/calibrate_hexapod.h"
#include "control/gap/gap_sensor.h"
#include "core/error.h"
#include "machine/optics_mounting.h"
#include "sim/as_built/truth.h"
#include "studies/calibration/sample_poses.h"
#include "studies/gap/sample_gaps.h"

namespace understudy::studies {
namespace {

using machine::MachineDescription;

constexpr const char* kBuilt = "manufactured";
constexpr double kHeights[] = {0.1e-3, 0.3e-3, 0.5e-3, 0.7e-3, 0.9e-3,
                               1.1e-3, 1.3e-3, 1.5e-3, 1.7e-3, 1.9e-3};  // [m]

calibration::MachineCalibration calibrate_geometry(const MachineDescription& drawn, std::uint64_t seed,
                                                   const LabCalibration& how) {
  SamplePosesRequest request;
  request.machine = drawn.file.string();
  request.as_built = kBuilt;
  request.seed = seed;
  request.engine = how.engine;
  request.count = how.poses;
  const calibration::Measurements measured = sample_poses(request, drawn);
  calibration::MachineCalibration result;
  result.estimator = how.estimator;
  result.noise_given = measured.noise_given;
  result.noise = request.noise;
  result.machine = drawn;
  const auto kind = drawn.is_chain() ? calibration::MachineKind::chain : calibration::MachineKind::hexapod;
  const auto estimator = calibration::make_estimator(result.estimator, kind);
  if (drawn.is_chain())
    calibrate_chain_machine(measured, drawn, *estimator, result);
  else
    calibrate_hexapod(measured, drawn, *estimator, result);
  result.machine.calibration = {result.estimator, "", "", static_cast<int>(measured.poses.size()),
                                result.tip.rms};
  return result;
}

void calibrate_gap_sensor(std::uint64_t seed, MachineDescription& machine) {
  if (!machine.tolerances.mounting)
    throw InputError({machine.file.string(), 0, 0},
                     "has no tolerances.mounting, within which its gap sensor is built and calibrated "
                     "(docs/machine-description.md)");
  SampleGapsRequest request;
  request.heights.assign(std::begin(kHeights), std::end(kHeights));
  request.as_built = kBuilt;
  request.seed = seed;
  std::vector<vision::DotMeasurement> dots;
  const vision::DotOptions options = control::dot_options(machine);
  const SampledGaps sample = sample_gaps(request, machine, [&](const std::string&, const Image& picture) {
    dots.push_back(vision::measure_dot(picture, options));
  });
  calibration::GapSensorProblem problem = calibration::gap_sensor_problem(machine);
  problem.slopes = sample.rows.slopes;
  problem.known = sample.rows.known;
  for (std::size_t i = 0; i < dots.size(); ++i)
    if (dots[i].status == vision::DotStatus::ok)
      problem.dots.push_back(calibration::seen_dot(sample.rows.rows[i], dots[i]));
  const calibration::GapSensorFit fit = calibration::fit_gap_sensor(problem);
  if (!fit.converged) throw MachineError("the gap sensor of a built machine could not be calibrated");
  calibration::set_gap_sensor(problem, fit, machine);
}

}  // namespace

CalibratedGeometry calibrate_lab_geometry(const MachineDescription& drawn, std::uint64_t seed,
                                          const LabCalibration& how) {
  calibration::MachineCalibration geometry = calibrate_geometry(drawn, seed, how);
  return {std::move(geometry.machine), std::move(geometry.stored)};
}

LabMachine make_lab_machine(const MachineDescription& drawn, std::uint64_t seed) {
  CalibratedGeometry geometry = calibrate_lab_geometry(drawn, seed);
  LabMachine lab;
  lab.machine = std::move(geometry.machine);
  lab.calibrated = std::move(geometry.calibrated);
  calibrate_gap_sensor(seed, lab.machine);
  lab.built = sim::make_as_built(drawn, kBuilt, seed);
  lab.truth = sim::true_description(lab.machine, lab.built);
  return lab;
}

}  // namespace understudy::studies
