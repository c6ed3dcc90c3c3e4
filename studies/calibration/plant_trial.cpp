// Trials of the calibration benchmark from end to end: a machine as built on a plant, driven through its
// port, photographed, calibrated, and driven again by what was found.
#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "calibration/bundle/calibrate_bundle.h"
#include "calibration/bundle/sides_by_loads.h"
#include "calibration/machine/calibrate_by_loads.h"
#include "calibration/machine/strut_sides.h"
#include "calibration/pose_choice.h"
#include "studies/calibration/calibration_trial.h"
#include "studies/calibration/disturbance.h"
#include "studies/calibration/driven_model.h"
#include "studies/calibration/plant_session.h"

namespace understudy::studies {
namespace {

using namespace calibration;

constexpr double kWarmingThought = 100e-6;  // [m] of growth that a lab thinks possible
constexpr std::size_t kRegistrationPoses = 20;
constexpr double kRangeMargin = 4e-3;  // [m], of a strut: joints and offsets are off by some 0.5 mm each

class TrialsOnPlant : public TrialRunner {
 public:
  explicit TrialsOnPlant(const TrialSetting& setting)
      : setting_(setting),
        machine_(*setting.machine),
        nominal_(machine_.hexapod().geometry),
        mechanism_(machine_.make_mechanism()) {
    held_out_ = within_ranges(setting.held_out, "held-out poses");
    registration_ = within_ranges(kRegistrationPoses, "registration poses");
  }

  Trial run(const Condition& condition, int machine, renderer::CalibrationView* view) const override;

 private:
  /// What was measured in one session.
  struct Measured {
    Problem poses;            ///< for the estimators: cameras first, then poses
    BundleProblem bundle;     ///< all pictures
    std::vector<Pose> truth;  ///< X_BT of the poses
  };

  /// Reachable poses that the machine as built reaches, too.
  std::vector<Pose> within_ranges(std::size_t count, const char* purpose) const;
  std::uint64_t machine_seed(int machine) const {
    return setting_.seed + static_cast<std::uint64_t>(machine);
  }
  sim::AsBuilt built(const Condition& condition, int machine) const;
  std::vector<Pose> chosen(const Condition& condition, int machine, const MeasuringStand& stand) const;
  SessionOptions session_options(const Condition& condition,
                                 const std::vector<std::vector<double>>& stops) const;
  Measured measure(const Condition& condition, int machine, const MeasuringStand& stand,
                   renderer::CalibrationView& view, std::unique_ptr<PlantSession>& session,
                   Trial& trial) const;
  BundleProblem bundle_of(const MeasuringStand& stand) const;
  BundleProblem bundle_for(const Method& method, const BundleProblem& measured) const;
  double bound(const MeasuringStand& stand, const sim::AsBuilt& as_built, const Measured& measured) const;
  bool drive(PlantSession& session, const DrivenModel& model, std::span<const Pose> asked,
             std::vector<Vec3>& errors) const;
  Answer answer(const Method& method, const Measured& measured, PlantSession& session,
                const std::vector<double>& uncalibrated) const;
  std::vector<Vec3> tips(std::span<const Pose> poses) const {
    std::vector<Vec3> points;
    for (const Pose& X_BT : poses) points.emplace_back(X_BT.translation());
    return points;
  }

  TrialSetting setting_;
  const machine::MachineDescription& machine_;
  HexapodGeometry nominal_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  std::vector<Pose> held_out_, registration_;
};

std::vector<Pose> TrialsOnPlant::within_ranges(std::size_t count, const char* purpose) const {
  Random random(setting_.seed, std::string("calibration benchmark/") + purpose);
  const PoseRegion region = reference_region(machine_.X_BT_home);
  std::vector<Pose> poses;
  while (poses.size() < count) {
    const Pose X_BT = random_reachable_poses(*mechanism_, region, 1, random)[0];
    std::vector<double> axes(kStruts);
    bool inside = mechanism_->inverse(X_BT, {}, axes) == kinematics::SolveStatus::ok;
    for (std::size_t i = 0; i < kStruts; ++i) {
      const auto range = mechanism_->axis_range(static_cast<int>(i));
      inside = inside && axes[i] > range.lower + kRangeMargin && axes[i] < range.upper - kRangeMargin;
    }
    if (inside) poses.push_back(X_BT);
  }
  return poses;
}

sim::AsBuilt TrialsOnPlant::built(const Condition& condition, int machine) const {
  sim::AsBuilt as_built = sim::make_as_built(machine_, "manufactured", machine_seed(machine));
  if (condition.disturbance == Disturbance::deviation) as_built.hexapod.deviation -= kDeviationError;
  if (condition.disturbance == Disturbance::play) {
    Random random(machine_seed(machine), "calibration benchmark/play on the plant");
    for (std::size_t i = 0; i < kStruts; ++i) {
      const double by = random.uniform(0.5, 1.5);
      as_built.nut_play[i] *= by;
      as_built.ball_play[i] *= by;
    }
  }
  return as_built;
}

std::vector<Pose> TrialsOnPlant::chosen(const Condition& condition, int machine,
                                        const MeasuringStand& stand) const {
  Random random(setting_.seed, fmt::format("calibration benchmark/poses/{}/{}", machine, condition.poses));
  const bool designed = setting_.choice == PoseChoice::d_optimal;
  const std::size_t count = designed ? std::max<std::size_t>(300, 4 * condition.poses) : condition.poses;
  const auto candidates = stand.poses_in_view(*mechanism_, count, random);
  if (!designed) return candidates;
  const DesignSetting design{{nominal_, {}}, MeasurementNoise{20e-6, 0.4e-3}.covariance(), {}};
  std::vector<Pose> poses;
  for (const std::size_t j : d_optimal(design, candidates, condition.poses, random))
    poses.push_back(candidates[j]);
  return poses;
}

SessionOptions TrialsOnPlant::session_options(const Condition& condition,
                                              const std::vector<std::vector<double>>& stops) const {
  SessionOptions options;
  options.engine = setting_.engine;
  if (condition.disturbance == Disturbance::drift) set_warming(machine_, kWarming, stops, options);
  return options;
}

/// What a controller knows before any picture.
BundleProblem TrialsOnPlant::bundle_of(const MeasuringStand& stand) const {
  BundleProblem problem;
  problem.rig = stand.designed();
  problem.uncertainty = stand.description().uncertainty;
  problem.boards = stand.boards();
  problem.X_WB = machine_.X_WB;
  problem.nominal = {nominal_, {}};
  const machine::Play& play = machine_.hexapod().play;
  for (double& p : problem.nominal.play) p = play.screw_nut + play.ball_joint;
  return problem;
}

TrialsOnPlant::Measured TrialsOnPlant::measure(const Condition& condition, int machine,
                                               const MeasuringStand& stand, renderer::CalibrationView& view,
                                               std::unique_ptr<PlantSession>& session, Trial& trial) const {
  const std::vector<Pose> asked = chosen(condition, machine, stand);
  std::vector<std::vector<double>> stops;
  for (const Pose& X_BT : asked) {
    std::vector<double> axes(kStruts);
    if (mechanism_->inverse(X_BT, {}, axes) != kinematics::SolveStatus::ok)
      throw std::logic_error("a chosen pose is out of reach");
    stops.push_back(axes);
  }
  session =
      std::make_unique<PlantSession>(machine_, built(condition, machine), session_options(condition, stops));
  Measured measured{{{nominal_, {}}, {}}, bundle_of(stand), {}};
  std::vector<CameraPose> seen;
  const Pose X_BW = machine_.X_WB.inverse();
  for (std::size_t j = 0; j < asked.size(); ++j) {
    const Pose X_WT = session->visit(stops[j]);
    const auto targets = stand.see(view, X_WT, machine_.X_WB * asked[j], 1000 * condition.poses + j);
    const CameraPose pose = stand.pose_of(targets);
    if (!pose.ok()) {
      ++trial.lost_poses;
      continue;
    }
    trial.beyond = std::max(trial.beyond, pose.beyond);
    seen.push_back(pose);
    BundlePose own;
    own.number = static_cast<int>(j) + 1;
    own.time = session->now();
    own.X_BT = asked[j];
    own.approach = resting_sides(machine_, nominal_, machine_.tolerances.manufactured, asked[j]);
    for (std::size_t i = 0; i < kStruts; ++i) own.displacement[i] = stops[j][i] - nominal_.length_offset[i];
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t k = 0; k < 3; ++k)
        own.targets[c][k] = {targets[c].targets[k].centre_px, targets[c].targets[k].covariance_px2};
    measured.bundle.poses.push_back(own);
    measured.truth.push_back(X_BW * X_WT);
  }
  take_out_frame(seen);
  for (std::size_t j = 0; j < seen.size(); ++j) {
    PoseSample sample;
    sample.X_BT = X_BW * seen[j].X_WT;
    sample.covariance = told_in(X_BW.linear(), seen[j].covariance);
    sample.displacement = measured.bundle.poses[j].displacement;
    sample.approach = measured.bundle.poses[j].approach;
    measured.poses.samples.push_back(sample);
  }
  return measured;
}

BundleProblem TrialsOnPlant::bundle_for(const Method& method, const BundleProblem& measured) const {
  BundleProblem problem = measured;
  problem.drives = drive_tolerance(machine_, method.with_play);
  problem.drives.warming = kWarmingThought;
  problem.unknowns = {true, method.with_play};
  if (!method.with_play) problem.nominal.play = {};
  return problem;
}

bool TrialsOnPlant::drive(PlantSession& session, const DrivenModel& model, std::span<const Pose> asked,
                          std::vector<Vec3>& errors) const {
  const Pose X_BW = machine_.X_WB.inverse();
  for (const Pose& X_BT : asked) {
    StrutLengths displacement;
    if (!model.displacements(machine_, X_BT, displacement)) return false;
    std::vector<double> axes(kStruts);
    for (std::size_t i = 0; i < kStruts; ++i) {
      axes[i] = displacement[i] + nominal_.length_offset[i];
      const auto range = mechanism_->axis_range(static_cast<int>(i));
      if (!(axes[i] >= range.lower && axes[i] <= range.upper)) return false;
    }
    errors.emplace_back((X_BW * session.visit(axes)).translation() - X_BT.translation());
  }
  return true;
}

/// The Cramer-Rao bound's RMS of the tip in W [m], at the poses held out, of all that bundle_with_play finds.
double TrialsOnPlant::bound(const MeasuringStand& stand, const sim::AsBuilt& as_built,
                            const Measured& measured) const {
  const BundleProblem problem = bundle_for({"", false, nullptr, true}, measured.bundle);
  BundleState truth = start_of(problem);
  truth.cameras = stand.built().cameras;
  truth.prints = stand.built().prints;
  for (std::size_t b = 0; b < problem.boards.size(); ++b)
    truth.boards[b] = stand.built().boards[static_cast<std::size_t>(problem.boards[b].camera)]
                                          [static_cast<std::size_t>(problem.boards[b].layer)];
  truth.machine.geometry = as_built.hexapod;
  for (std::size_t i = 0; i < kStruts; ++i) {
    truth.machine.play[i] = as_built.nut_play[i] + as_built.ball_play[i];
    truth.lead[i] = as_built.drives[i].scale;
  }
  truth.poses = measured.truth;
  const Eigen::MatrixXd covariance = bundle_bound(problem, truth);
  if (covariance.size() == 0) return 0;
  const DrivenModel model{truth.machine, truth.lead, true};
  const ErrorModel errors = tip_errors_of(problem, model, machine_, held_out_);
  double square = (errors.rows * covariance * errors.rows.transpose()).trace();
  for (const Mat3& own : errors.own) square += own.trace();
  return std::sqrt(square / static_cast<double>(held_out_.size()));
}

std::vector<double> norms(const std::vector<Vec3>& errors) {
  std::vector<double> sizes;
  for (const Vec3& e : errors) sizes.push_back(e.norm());
  return sizes;
}

void state(const std::vector<Vec3>& errors, const std::vector<Mat3>& covariances, StatedErrors& stated) {
  for (std::size_t k = 0; k < errors.size(); ++k) {
    stated.stated.push_back(std::sqrt(covariances[k].trace()));
    stated.normalised.push_back(errors[k].dot(covariances[k].ldlt().solve(errors[k])));
  }
}

Answer TrialsOnPlant::answer(const Method& method, const Measured& measured, PlantSession& session,
                             const std::vector<double>& uncalibrated) const {
  Answer result;
  DrivenModel model;
  BundleProblem problem;
  BundleAdjustment adjusted;
  const auto start = std::chrono::steady_clock::now();
  if (method.estimator) {
    Problem poses = measured.poses;
    const Calibration found = calibrate_by_loads(machine_, *method.estimator, poses);
    result.failure = failure_of(found);
    model = {found.parameters, {}, method.estimator->unknowns().play};
  } else {
    problem = bundle_for(method, measured.bundle);
    adjusted = adjust_bundle_by_loads(machine_, problem);
    if (!adjusted.ok()) result.failure = to_string(adjusted.status);
    result.misfit = std::sqrt(adjusted.chi_square / static_cast<double>(adjusted.degrees_of_freedom));
    model = {adjusted.state.machine, adjusted.state.lead, method.with_play};
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!result.ok()) return result;
  std::vector<Vec3> at_registration, at_held_out;
  if (!drive(session, model, registration_, at_registration) ||
      !drive(session, model, held_out_, at_held_out)) {
    result.failure = "the answer cannot reach the poses held out";
    return result;
  }
  result.errors = norms(at_held_out);
  judge(uncalibrated, result);
  if (!result.ok()) return result;
  const Eigen::MatrixXd M = registration_of(tips(registration_), tips(held_out_));
  const std::vector<Vec3> left = registered_errors(M, at_registration, at_held_out);
  result.in_frame.errors = result.errors;
  result.registered.errors = norms(left);
  if (method.estimator) return result;
  const auto at_registered = tip_errors_of(problem, model, machine_, registration_);
  const auto held_out = tip_errors_of(problem, model, machine_, held_out_);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(M.rows(), M.cols());
  state(at_held_out, registered_covariances(none, at_registered, held_out, adjusted.covariance),
        result.in_frame);
  state(left, registered_covariances(M, at_registered, held_out, adjusted.covariance), result.registered);
  return result;
}

Trial TrialsOnPlant::run(const Condition& condition, int machine, renderer::CalibrationView* view) const {
  StandOptions options = setting_.stand_options;
  options.seed = machine_seed(machine);
  const MeasuringStand stand(machine_, options, 1);
  Trial trial;
  std::unique_ptr<PlantSession> session;
  const Measured measured = measure(condition, machine, stand, *view, session, trial);
  std::vector<Vec3> as_built;
  if (!drive(*session, {{nominal_, {}}, {}, false}, held_out_, as_built))
    throw std::logic_error("a pose held out is out of reach");
  trial.uncalibrated = norms(as_built);
  trial.bound = bound(stand, built(condition, machine), measured);
  for (const Method& method : setting_.entrants)
    trial.answers.push_back(answer(method, measured, *session, trial.uncalibrated));
  return trial;
}

}  // namespace

std::unique_ptr<TrialRunner> make_plant_trials(const TrialSetting& setting) {
  return std::make_unique<TrialsOnPlant>(setting);
}

}  // namespace understudy::studies
