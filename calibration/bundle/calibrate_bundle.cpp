#include "calibration/bundle/calibrate_bundle.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/LU>

#include "calibration/bundle/bundle_tables.h"
#include "calibration/bundle/picture_pose.h"
#include "calibration/bundle/sides_by_loads.h"
#include "calibration/calibrated.h"
#include "calibration/machine/calibrate_hexapod.h"
#include "calibration/strut_model.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "machine/built_tolerances.h"

namespace understudy::calibration {
namespace {

constexpr const char* kWithPlay = "bundle_with_play";
constexpr const char* kWithoutPlay = "bundle";

double half_play(const machine::MachineDescription& machine) {
  const machine::Play& play = machine.hexapod().play;
  return 0.5 * (play.screw_nut + play.ball_joint);
}

void add_poses(const BundleRequest& request, const Measurements& commanded,
               const machine::MachineDescription& machine, BundleProblem& problem,
               std::vector<std::string>& warnings) {
  const Pose X_BW = machine.X_WB.inverse();
  for (const PoseTargets& seen : read_targets(request.targets)) {
    if (seen.pose > static_cast<int>(commanded.poses.size()))
      throw InputError({request.targets, seen.line, 0},
                       fmt::format("pose {} is not commanded: {} has {}", seen.pose, request.commanded,
                                   commanded.poses.size()));
    if (seen.found < 6) {
      warnings.push_back(fmt::format("pose {}: {} of 6 targets were found; left out", seen.pose, seen.found));
      continue;
    }
    const MeasuredPose& row = commanded.poses[static_cast<std::size_t>(seen.pose - 1)];
    BundlePose pose;
    pose.number = seen.pose;
    pose.time = seen.pose;  // poses follow each other evenly
    pose.X_BT = X_BW * row.X_WT;
    pose.approach = row.approach;
    pose.targets = seen.targets;
    StrutLengths lengths{};
    std::copy_n(row.axes.begin(), lengths.size(), lengths.begin());
    pose.displacement = displacements(problem.nominal.geometry, lengths);
    problem.poses.push_back(pose);
  }
}

BundleProblem problem_of(const BundleRequest& request, const machine::MachineDescription& machine,
                         const Measurements& commanded, std::vector<std::string>& warnings) {
  const vision::RigDescription rig = vision::load_rig(request.rig);
  BundleProblem problem;
  problem.rig = rig.rig;
  problem.uncertainty = rig.uncertainty;
  problem.boards = read_corners(request.corners, rig.rig);
  problem.X_WB = machine.X_WB;
  problem.nominal = {machine.hexapod().geometry, {}};
  problem.unknowns = {true, commanded.approach_told};
  if (problem.unknowns.play) problem.nominal.play.fill(2 * half_play(machine));
  problem.drives = drive_tolerance(machine, problem.unknowns.play);
  problem.drives.warming = request.warming;
  add_poses(request, commanded, machine, problem, warnings);
  return problem;
}

/// As an estimator of measured poses reports: residuals are those of the poses that the pictures show.
Calibration as_calibration(const BundleProblem& problem, const BundleAdjustment& adjusted, Problem& poses) {
  Calibration found;
  found.status = adjusted.status;
  found.parameters = adjusted.state.machine;
  const Eigen::Index count = problem.unknowns.count();
  found.covariance = adjusted.covariance.topLeftCorner(count, count);
  poses.nominal = problem.nominal;
  for (std::size_t j = 0; j < problem.poses.size(); ++j) {
    PoseSample sample;
    StrutLinearisation at;
    if (!picture_pose(problem, adjusted.state, j, sample) ||
        !linearise(found.parameters, sample, sample.X_BT, at))
      throw InputError({}, fmt::format("pose {}: its pictures show no pose", problem.poses[j].number));
    const Mat6 by_length = at.by_pose.inverse();
    const bool unknown_side = problem.unknowns.play;
    Twist variance;
    for (std::size_t i = 0; i < kStruts; ++i) {
      const bool side = unknown_side && sample.approach[i] == Approach::unknown;
      variance[static_cast<Eigen::Index>(i)] =
          std::pow(std::hypot(problem.drives.length, side ? problem.drives.side_unknown : 0), 2);
    }
    sample.covariance += by_length * variance.asDiagonal() * by_length.transpose();
    poses.samples.push_back(sample);
  }
  found.used.assign(poses.samples.size(), true);
  add_residuals(poses, problem.unknowns, found);
  found.chi_square = adjusted.chi_square;
  found.degrees_of_freedom = static_cast<int>(adjusted.degrees_of_freedom);
  found.iterations = adjusted.iterations;
  const std::string misfit = misfit_warning(found.chi_square, found.degrees_of_freedom,
                                            "a board that bends, targets off their places, heat, play");
  if (!misfit.empty()) found.warnings.push_back(misfit);
  return found;
}

}  // namespace

DriveTolerance drive_tolerance(const machine::MachineDescription& machine, bool play_unknown) {
  const auto tolerances = machine::load_built_tolerances(machine.file.string());
  DriveTolerance drives;
  // A sine of normal amplitude has half of the square of its tolerance, a rounded step a twelfth.
  drives.length =
      std::hypot(tolerances.periodic / std::numbers::sqrt2, machine.drives[0].step() / std::sqrt(12.0));
  drives.lead = tolerances.lead;
  if (play_unknown) {
    const machine::Play& play = machine.hexapod().play;
    drives.play = tolerances.play * std::hypot(play.screw_nut, play.ball_joint);
    drives.side_unknown = half_play(machine);
  } else {
    drives.length = std::hypot(drives.length, half_play(machine));
  }
  return drives;
}

MachineCalibration calibrate_bundle(const BundleRequest& request) {
  MachineCalibration result;
  result.file = request.targets;
  result.command = request.command;
  result.noise_given = true;
  result.machine = machine::load_machine(request.machine);
  const machine::MachineDescription nominal = result.machine;
  if (nominal.is_chain())
    throw InputError(fmt::format("{}: pictures are adjusted with a hexapod only", nominal.name));
  const Measurements commanded = read_measurements(request.commanded, nominal, kReferenceNoise);
  BundleProblem problem = problem_of(request, nominal, commanded, result.warnings);
  result.estimator = problem.unknowns.play ? kWithPlay : kWithoutPlay;
  const BundleAdjustment adjusted = adjust_bundle_by_loads(nominal, problem);
  if (!adjusted.ok()) throw InputError({request.targets, 0, 0}, adjusted.message);
  Problem poses;
  const Calibration found = as_calibration(problem, adjusted, poses);
  Measurements rows;
  rows.file = request.targets;
  for (const BundlePose& pose : problem.poses) {
    rows.poses.push_back(commanded.poses[static_cast<std::size_t>(pose.number - 1)]);
    rows.poses.back().X_WT = nominal.X_WB * poses.samples[rows.poses.size() - 1].X_BT;
  }
  report_hexapod(poses, found, problem.unknowns, rows, nominal, result);
  result.machine.calibration = {result.estimator, std::filesystem::path(request.targets).filename().string(),
                                sha256_hex(read_file(request.targets)),
                                static_cast<int>(problem.poses.size()), result.tip.rms};
  return result;
}

}  // namespace understudy::calibration
