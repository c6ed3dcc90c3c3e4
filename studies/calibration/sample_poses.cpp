#include "studies/calibration/sample_poses.h"

#include <Eigen/Cholesky>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "calibration/machine/strut_sides.h"
#include "calibration/pose_choice.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "sim/as_built/as_built.h"
#include "studies/calibration/pixel_measurement.h"
#include "studies/calibration/plant_session.h"

namespace understudy::studies {
namespace {

using namespace calibration;
using machine::MachineDescription;

std::vector<Pose> chain_design(const MachineDescription& machine, const std::vector<Pose>& candidates,
                               const kinematics::Mechanism& mechanism, const SamplePosesRequest& request) {
  // D-optimal by the same information, but forwards only: a chain lists parameters that no pose tells.
  const ChainParameters known{machine.chain().kinematics.chain, {}};
  const Mat6 root = request.noise.covariance().llt().matrixL();
  std::vector<Eigen::MatrixXd> rows;
  for (const Pose& X_BT : candidates) {
    std::vector<double> axes(static_cast<std::size_t>(mechanism.axis_count()));
    if (mechanism.inverse(X_BT, {}, axes) != kinematics::SolveStatus::ok)
      throw std::logic_error("a candidate pose has no axes");  // candidates are chosen from reachable poses
    rows.push_back(root.triangularView<Eigen::Lower>().solve(chain_rows(known, axes)));
  }
  constexpr double kPrior = 0.01;  // [m] and [rad]: weak
  Eigen::MatrixXd inverse = kPrior * kPrior * Eigen::MatrixXd::Identity(rows[0].cols(), rows[0].cols());
  std::vector<bool> chosen(candidates.size(), false);
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < request.count && poses.size() < candidates.size()) {
    double best = -1;
    std::size_t at = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (chosen[j]) continue;
      const double gain = (Mat6::Identity() + rows[j] * inverse * rows[j].transpose()).determinant();
      if (gain > best) best = gain, at = j;
    }
    const Eigen::MatrixXd& row = rows[at];
    const Mat6 S = Mat6::Identity() + row * inverse * row.transpose();
    inverse -= inverse * row.transpose() * S.llt().solve(row * inverse).eval();
    chosen[at] = true;
    poses.push_back(candidates[at]);
  }
  return poses;
}

/// All axes within their ranges: an arm's poses must turn every axis, which a region of poses does not ask.
std::vector<Pose> chain_candidates(const MachineDescription& machine, const kinematics::Mechanism& mechanism,
                                   std::size_t count, Random& random) {
  PoseRegion region = reference_region(machine.X_BT_home);
  constexpr double kArmTilt = 0.7, kArmYaw = std::numbers::pi / 2;  // [rad]: wrists turn far
  region.tilt_max = kArmTilt;
  region.yaw_max = kArmYaw;
  region.half_size = Vec3::Constant(0.1);
  return random_reachable_poses(mechanism, region, count, random);
}

/// The best of `candidates`, or all of them.
std::vector<Pose> designed(const SamplePosesRequest& request, const MachineDescription& machine,
                           const kinematics::Mechanism& mechanism, const std::vector<Pose>& candidates,
                           Random& random) {
  if (request.design != "d-optimal") return candidates;
  if (machine.is_chain()) return chain_design(machine, candidates, mechanism, request);
  const DesignSetting setting{{machine.hexapod().geometry, {}}, request.noise.covariance(), {}};
  std::vector<Pose> poses;
  for (const std::size_t j : d_optimal(setting, candidates, static_cast<std::size_t>(request.count), random))
    poses.push_back(candidates[j]);
  return poses;
}

std::vector<Pose> choose(const SamplePosesRequest& request, const MachineDescription& machine,
                         const kinematics::Mechanism& mechanism, const MeasuringStand* stand) {
  Random random(request.seed, "calibration poses");
  const auto drawn = static_cast<std::size_t>(
      request.design == "d-optimal" ? std::max(request.candidates, request.count) : request.count);
  const auto candidates =
      stand ? stand->poses_in_view(mechanism, drawn, random)
      : machine.is_chain()
          ? chain_candidates(machine, mechanism, drawn, random)
          : random_reachable_poses(mechanism, reference_region(machine.X_BT_home), drawn, random);
  return designed(request, machine, mechanism, candidates, random);
}

/// Where the twin's geometry puts the tool; false where it has no answer.
bool true_pose(const MachineDescription& machine, const sim::AsBuilt& built, const std::vector<double>& axes,
               const Pose& X_BT_asked, Pose& X_BT) {
  if (machine.is_chain()) {
    const std::vector<double> zero(built.axis_zero.begin(),
                                   built.axis_zero.begin() + static_cast<std::ptrdiff_t>(axes.size()));
    X_BT = calibration::forward({built.chain, zero}, axes);
    return true;
  }
  kinematics::StrutLengths lengths{};
  for (std::size_t i = 0; i < lengths.size(); ++i)
    lengths[i] = axes[i] - machine.hexapod().geometry.length_offset[i] + built.hexapod.length_offset[i];
  const auto reached = kinematics::forward(built.hexapod, lengths, X_BT_asked);
  X_BT = reached.X_BT;
  return reached.status == kinematics::SolveStatus::ok;
}

void check(const SamplePosesRequest& request, const MachineDescription& machine) {
  if (machine.is_chain() && !machine.chain().kinematics.chain.rods.empty())
    throw InputError(machine.name + ": the estimators know trees of axes, and here rods carry the tool");
  if (request.from_pixels && machine.is_chain())
    throw InputError("pictures of the targets are taken of a hexapod only");
  if (request.from_pixels && !request.as_built)
    throw InputError("pictures need a machine that stands there: --as-built");
  if (!request.engine.empty() && !request.as_built)
    throw InputError("--engine needs a machine that is driven: --as-built");
  if (request.warming != 0 && (request.engine.empty() || machine.is_chain()))
    throw InputError("--warming: screws warm on a plant (--engine), and an open chain has none");
  if (request.count < 1 || request.count > 10000)
    throw InputError(fmt::format("--count {} is outside 1..10000", request.count));
  if (request.candidates < 1 || request.candidates > 10000)
    throw InputError(fmt::format("--candidates {} is outside 1..10000", request.candidates));
  if (request.design != "random" && request.design != "d-optimal")
    throw InputError(fmt::format("--design {} is not one of random, d-optimal", request.design));
}

/// The twin, driven to axes: by forward kinematics, or on a plant.
class DrivenTwin {
 public:
  DrivenTwin(const SamplePosesRequest& request, const MachineDescription& machine,
             const std::vector<MeasuredPose>& asked)
      : machine_(machine), built_(sim::make_as_built(machine, *request.as_built, request.seed)) {
    if (request.engine.empty()) return;
    SessionOptions options;
    options.engine = request.engine;
    if (request.warming != 0) {
      std::vector<std::vector<double>> stops;
      for (const MeasuredPose& pose : asked) stops.push_back(pose.axes);
      set_warming(machine, request.warming, stops, options);
    }
    session_ = std::make_unique<PlantSession>(machine, built_, options);
  }

  /// False where forward kinematics has no answer.
  bool visit(const MeasuredPose& asked, Pose& X_WT) {
    if (session_) {
      X_WT = session_->visit(asked.axes);
      return true;
    }
    Pose X_BT;
    if (!true_pose(machine_, built_, asked.axes, machine_.X_WB.inverse() * asked.X_WT, X_BT)) return false;
    X_WT = machine_.X_WB * X_BT;
    return true;
  }

 private:
  const MachineDescription& machine_;
  sim::AsBuilt built_;
  std::unique_ptr<PlantSession> session_;
};

/// What measures the twin: noise of a known covariance, or two cameras.
class Measurer {
 public:
  Measurer(const SamplePosesRequest& request, std::unique_ptr<MeasuringStand> stand)
      : covariance_(request.noise.covariance()),
        noise_(request.seed, "calibration noise"),
        stand_(std::move(stand)) {
    if (stand_) view_ = std::make_unique<renderer::CalibrationView>();
  }
  const MeasuringStand* stand() const { return stand_.get(); }

  /// Of the commanded `pose`, from pictures the `number`th, it makes the measured one; false where the
  /// cameras find none. Its covariance is known when all poses are: finish().
  bool measure(const Pose& X_WT_true, std::uint64_t number, MeasuredPose& pose) {
    if (stand_) {
      const CameraPose seen = stand_->measure(*view_, X_WT_true, pose.X_WT, number);
      pose.X_WT = seen.X_WT;
      if (seen.ok()) seen_.push_back(seen);
      return seen.ok();
    }
    Twist unit;
    for (Eigen::Index k = 0; k < 6; ++k) unit[k] = noise_.normal();
    const Twist e = covariance_.llt().matrixL() * unit;
    pose.X_WT = make_pose(Mat3(exp_rotation(e.tail<3>()) * X_WT_true.linear()),
                          X_WT_true.translation() + e.head<3>());
    pose.covariance = covariance_;
    return true;
  }

  void finish(Measurements& sample) {
    if (!stand_) return;
    sample.frame = take_out_frame(seen_);
    for (std::size_t j = 0; j < seen_.size(); ++j) sample.poses[j].covariance = seen_[j].covariance;
  }

 private:
  Mat6 covariance_;
  Random noise_;
  std::unique_ptr<MeasuringStand> stand_;
  std::unique_ptr<renderer::CalibrationView> view_;
  std::vector<CameraPose> seen_;
};

/// The poses asked for, with their axes and, where a plant has plays, the sides on which these rest.
std::vector<MeasuredPose> asked_poses(const SamplePosesRequest& request, const MachineDescription& machine,
                                      const MeasuringStand* stand) {
  const auto mechanism = machine.make_mechanism();
  std::vector<MeasuredPose> asked;
  for (const Pose& X_BT : choose(request, machine, *mechanism, stand)) {
    MeasuredPose pose;
    pose.axes.resize(static_cast<std::size_t>(mechanism->axis_count()));
    if (mechanism->inverse(X_BT, {}, pose.axes) != kinematics::SolveStatus::ok) continue;
    pose.X_WT = machine.X_WB * X_BT;
    if (!request.engine.empty() && !machine.is_chain())
      pose.approach = resting_sides(
          machine, machine.hexapod().geometry,
          machine.calibration ? machine.tolerances.after_calibration : machine.tolerances.manufactured, X_BT);
    asked.push_back(std::move(pose));
  }
  return asked;
}

std::unique_ptr<MeasuringStand> make_stand(const SamplePosesRequest& request,
                                           const MachineDescription& machine,
                                           const std::function<void(double)>& progress,
                                           const PictureRecord* record) {
  if (!request.from_pixels) return nullptr;
  StandOptions options;
  options.seed = request.seed;
  options.boards = request.boards;
  if (record) options.keep = record->keep;
  return std::make_unique<MeasuringStand>(machine, options, 1, progress);
}

}  // namespace

Measurements sample_poses(const SamplePosesRequest& request, const MachineDescription& machine,
                          const std::function<void(double)>& progress, PictureRecord* record) {
  check(request, machine);
  Measurements sample, commanded, truth;
  sample.noise_given = request.as_built.has_value();
  for (Measurements* table : {&sample, &commanded, &truth})
    table->approach_told = !request.engine.empty() && !machine.is_chain();
  std::unique_ptr<MeasuringStand> stand = make_stand(request, machine, progress, record);
  if (record && stand) record->rig = stand->description(), record->built = stand->built();
  Measurer measurer(request, std::move(stand));
  const std::vector<MeasuredPose> asked = asked_poses(request, machine, measurer.stand());
  std::optional<DrivenTwin> twin;
  if (request.as_built) twin.emplace(request, machine, asked);
  std::uint64_t number = 0;
  for (MeasuredPose pose : asked) {
    stop_if_interrupted();
    if (twin) {
      Pose X_WT;
      if (!twin->visit(pose, X_WT)) continue;
      commanded.poses.push_back(pose);
      truth.poses.push_back(pose);
      truth.poses.back().X_WT = X_WT;
      if (!measurer.measure(X_WT, ++number, pose)) continue;
    }
    sample.poses.push_back(std::move(pose));
  }
  measurer.finish(sample);
  if (record) record->commanded = std::move(commanded), record->truth = std::move(truth);
  return sample;
}

}  // namespace understudy::studies
