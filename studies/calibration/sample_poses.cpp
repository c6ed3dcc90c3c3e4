#include "studies/calibration/sample_poses.h"

#include <Eigen/Cholesky>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "calibration/pose_choice.h"
#include "core/error.h"
#include "sim/as_built/as_built.h"
#include "studies/calibration/pixel_measurement.h"

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
  if (request.from_pixels && machine.is_chain())
    throw InputError("pictures of the targets are taken of a hexapod only");
  if (request.from_pixels && !request.as_built)
    throw InputError("pictures need a machine that stands there: --as-built");
  if (request.count < 1 || request.count > 10000)
    throw InputError(fmt::format("--count {} is outside 1..10000", request.count));
  if (request.candidates < 1 || request.candidates > 10000)
    throw InputError(fmt::format("--candidates {} is outside 1..10000", request.candidates));
  if (request.design != "random" && request.design != "d-optimal")
    throw InputError(fmt::format("--design {} is not one of random, d-optimal", request.design));
}

/// What measures the twin: noise of a known covariance, or two cameras.
class Measurer {
 public:
  Measurer(const SamplePosesRequest& request, const MachineDescription& machine,
           std::unique_ptr<MeasuringStand> stand)
      : X_WB_(machine.X_WB),
        covariance_(request.noise.covariance()),
        noise_(request.seed, "calibration noise"),
        stand_(std::move(stand)) {
    if (stand_) view_ = std::make_unique<renderer::CalibrationView>();
  }
  const MeasuringStand* stand() const { return stand_.get(); }

  /// Of the commanded `pose`, from pictures the `number`th, it makes the measured one; false where the
  /// cameras find none. Its covariance is known when all poses are: finish().
  bool measure(const Pose& X_BT_true, std::uint64_t number, MeasuredPose& pose) {
    if (stand_) {
      const CameraPose seen = stand_->measure(*view_, X_WB_ * X_BT_true, pose.X_WT, number);
      pose.X_WT = seen.X_WT;
      if (seen.ok()) seen_.push_back(seen);
      return seen.ok();
    }
    Twist unit;
    for (Eigen::Index k = 0; k < 6; ++k) unit[k] = noise_.normal();
    const Twist e = covariance_.llt().matrixL() * unit;
    const Pose X_WT = X_WB_ * X_BT_true;
    pose.X_WT = make_pose(Mat3(exp_rotation(e.tail<3>()) * X_WT.linear()), X_WT.translation() + e.head<3>());
    pose.covariance = covariance_;
    return true;
  }

  void finish(Measurements& sample) {
    if (!stand_) return;
    sample.frame = take_out_frame(seen_);
    for (std::size_t j = 0; j < seen_.size(); ++j) sample.poses[j].covariance = seen_[j].covariance;
  }

 private:
  Pose X_WB_;
  Mat6 covariance_;
  Random noise_;
  std::unique_ptr<MeasuringStand> stand_;
  std::unique_ptr<renderer::CalibrationView> view_;
  std::vector<CameraPose> seen_;
};

}  // namespace

Measurements sample_poses(const SamplePosesRequest& request, const MachineDescription& machine,
                          const std::function<void(double)>& progress, PictureRecord* record) {
  check(request, machine);
  const auto mechanism = machine.make_mechanism();
  Measurements sample;
  sample.noise_given = request.as_built.has_value();
  std::optional<sim::AsBuilt> built;
  if (request.as_built) built = sim::make_as_built(machine, *request.as_built, request.seed);
  std::unique_ptr<MeasuringStand> stand;
  if (request.from_pixels) {
    StandOptions options;
    options.seed = request.seed;
    if (record) options.keep = record->keep;
    stand = std::make_unique<MeasuringStand>(machine, options, 1, progress);
  }
  if (record && stand) record->rig = stand->description(), record->built = stand->built();
  Measurements commanded, truth;
  Measurer measurer(request, machine, std::move(stand));
  std::uint64_t number = 0;
  for (const Pose& X_BT : choose(request, machine, *mechanism, measurer.stand())) {
    MeasuredPose pose;
    pose.axes.resize(static_cast<std::size_t>(mechanism->axis_count()));
    if (mechanism->inverse(X_BT, {}, pose.axes) != kinematics::SolveStatus::ok) continue;
    pose.X_WT = machine.X_WB * X_BT;
    if (built) {
      Pose X_true;
      if (!true_pose(machine, *built, pose.axes, X_BT, X_true)) continue;
      commanded.poses.push_back(pose);
      truth.poses.push_back(pose);
      truth.poses.back().X_WT = machine.X_WB * X_true;
      if (!measurer.measure(X_true, ++number, pose)) continue;
    }
    sample.poses.push_back(std::move(pose));
  }
  measurer.finish(sample);
  if (record) record->commanded = std::move(commanded), record->truth = std::move(truth);
  return sample;
}

}  // namespace understudy::studies
