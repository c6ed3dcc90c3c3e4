#include "studies/calibration/calibration_trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "calibration/bound.h"
#include "sim/as_built/as_built.h"
#include "studies/calibration/disturbance.h"
#include "studies/calibration/warming.h"

namespace understudy::studies {
namespace {

using namespace calibration;

class HexapodTrials : public TrialRunner {
 public:
  explicit HexapodTrials(const TrialSetting& setting)
      : setting_(setting),
        machine_(*setting.machine),
        nominal_(machine_.hexapod().geometry),
        mechanism_(machine_.make_mechanism()),
        region_(reference_region(machine_.X_BT_home)) {
    Random random(setting.seed, "calibration benchmark/held-out poses");
    held_out_ = random_reachable_poses(*mechanism_, region_, setting.held_out, random);
  }

  Trial run(const Condition& condition, int machine, renderer::CalibrationView* view) const override {
    Problem problem{{nominal_, {}}, {}};
    Trial trial;
    HexapodParameters truth = built(condition, machine);
    std::vector<PoseSample> exact = exact_samples(condition, machine, truth);
    trial.uncalibrated = tip_errors(truth, problem.nominal);
    if (setting_.stand)
      photograph(condition, machine, exact, *view, problem, trial);
    else
      measure(condition, machine, exact, problem);
    spoil(condition, machine, problem);
    if (!setting_.stand) trial.bound = bound(condition, truth, exact);
    for (const Method& method : setting_.entrants)
      trial.answers.push_back(answer(method, problem, truth, trial.uncalibrated));
    return trial;
  }

 private:
  Random stream(const char* purpose, const Condition& condition, int machine) const {
    return {setting_.seed, fmt::format("calibration benchmark/{}/{}/{}/{}/{:.9g}/{:.9g}", purpose, machine,
                                       condition.poses, to_string(condition.disturbance),
                                       condition.noise.position, condition.noise.rotation)};
  }

  HexapodParameters built(const Condition& condition, int machine) const {
    const auto as_built =
        sim::make_as_built(machine_, "manufactured", setting_.seed + static_cast<std::uint64_t>(machine));
    HexapodParameters truth{as_built.hexapod, {}};
    if (condition.disturbance == Disturbance::deviation) truth.geometry.deviation -= kDeviationError;
    if (condition.disturbance == Disturbance::play) {
      Random random = stream("play", condition, machine);
      for (std::size_t i = 0; i < kStruts; ++i)
        truth.play[i] = random.uniform(0.5, 1.5) * (as_built.nut_play[i] + 2 * as_built.ball_play[i]);
    }
    return truth;
  }

  std::vector<Pose> asked(const Condition& condition, int machine) const {
    Random random(setting_.seed, fmt::format("calibration benchmark/poses/{}/{}", machine, condition.poses));
    const bool chosen = setting_.choice == PoseChoice::d_optimal;
    const std::size_t count = chosen ? std::max<std::size_t>(300, 4 * condition.poses) : condition.poses;
    const auto candidates = setting_.stand ? setting_.stand->poses_in_view(*mechanism_, count, random)
                                           : random_reachable_poses(*mechanism_, region_, count, random);
    if (!chosen) return candidates;
    const auto noise = setting_.stand ? MeasurementNoise{20e-6, 0.4e-3} : condition.noise;
    const DesignSetting design{{nominal_, {}}, noise.covariance(), {}};
    std::vector<Pose> poses;
    for (const std::size_t j : d_optimal(design, candidates, condition.poses, random))
      poses.push_back(candidates[j]);
    return poses;
  }

  /// Where the drives really put the platform. Under drift, `truth` is the warm machine.
  std::vector<PoseSample> exact_samples(const Condition& condition, int machine,
                                        HexapodParameters& truth) const {
    Random random = stream("approach", condition, machine);
    const bool drift = condition.disturbance == Disturbance::drift;
    const std::vector<Pose> poses = asked(condition, machine);
    std::vector<PoseSample> samples;
    const HexapodParameters cold = truth;
    for (std::size_t j = 0; j < poses.size(); ++j) {
      kinematics::PerStrut<Approach> approach{};
      for (Approach& a : approach) a = random.uniform() < 0.5 ? Approach::shortening : Approach::lengthening;
      const double time =
          poses.size() > 1 ? static_cast<double>(j) / static_cast<double>(poses.size() - 1) : 1;
      if (drift) truth = warmed(cold, kWarming * (1 - std::exp(-kSessionTimeConstants * time)));
      PoseSample sample;
      if (true_sample(truth, nominal_, poses[j], condition.noise, approach, sample))
        samples.push_back(sample);
    }
    return samples;
  }

  /// Screws that are `rise` [K] warmer: their middle length is the longer.
  HexapodParameters warmed(HexapodParameters machine, double rise) const {
    for (double& l : machine.geometry.length_offset) l += strut_growth(machine_, rise);
    return machine;
  }

  void measure(const Condition& condition, int machine, const std::vector<PoseSample>& exact,
               Problem& problem) const {
    Random random = stream("noise", condition, machine);
    Random frame_random = stream("frame", condition, machine);
    const FrameError frame(region_.centre_B, frame_random);
    for (const PoseSample& sample : exact) {
      problem.samples.push_back(measured(sample, random));
      if (condition.disturbance == Disturbance::boards)
        problem.samples.back().X_BT = frame.seen(problem.samples.back().X_BT);
    }
  }

  void photograph(const Condition& condition, int machine, const std::vector<PoseSample>& exact,
                  renderer::CalibrationView& view, Problem& problem, Trial& trial) const {
    const MeasuringStand& stand =
        condition.disturbance == Disturbance::boards ? *setting_.misplaced_stand : *setting_.stand;
    std::vector<CameraPose> poses;
    for (std::size_t j = 0; j < exact.size(); ++j) {
      const PoseSample& sample = exact[j];
      const auto expected = kinematics::forward(nominal_, commanded(sample), machine_.X_BT_home);
      const std::uint64_t frame =
          hash_bits(setting_.seed + static_cast<std::uint64_t>(machine), 1000 * condition.poses + j);
      poses.push_back(stand.measure(view, machine_.X_WB * sample.X_BT, machine_.X_WB * expected.X_BT, frame));
    }
    take_out_frame(poses);
    const Pose X_BW = machine_.X_WB.inverse();
    for (std::size_t j = 0; j < exact.size(); ++j) {
      if (!poses[j].ok()) {
        ++trial.lost_poses;
        continue;
      }
      PoseSample sample = exact[j];
      sample.X_BT = X_BW * poses[j].X_WT;
      sample.covariance = told_in(X_BW.linear(), poses[j].covariance);
      trial.beyond = std::max(trial.beyond, poses[j].beyond);
      problem.samples.push_back(sample);
    }
  }

  StrutLengths commanded(const PoseSample& sample) const {
    StrutLengths lengths;
    for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = nominal_.length_offset[i] + sample.displacement[i];
    return lengths;
  }

  /// Single wrong measurements, which their covariance does not tell.
  void spoil(const Condition& condition, int machine, Problem& problem) const {
    if (condition.disturbance != Disturbance::outliers || problem.samples.empty()) return;
    Random random = stream("outliers", condition, machine);
    std::vector<PoseSample>& samples = problem.samples;
    const std::size_t count = outlier_count(samples.size());
    std::vector<std::size_t> order(samples.size());
    for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
    for (std::size_t n = 0; n < count; ++n) {
      const auto left = static_cast<double>(order.size() - n);
      std::swap(order[n], order[n + static_cast<std::size_t>(random.uniform() * left)]);
      PoseSample wrong = samples[order[n]];
      wrong.covariance = kOutlier.covariance();
      samples[order[n]].X_BT = measured(wrong, random).X_BT;
    }
  }

  /// Of the unknowns that the machine really has; what is systematic is not in it.
  double bound(const Condition& condition, const HexapodParameters& truth,
               const std::vector<PoseSample>& exact) const {
    const Unknowns unknowns{condition.disturbance == Disturbance::deviation,
                            condition.disturbance == Disturbance::play};
    const ParameterMatrix covariance = parameter_bound(truth, exact, unknowns);
    return covariance.size() == 0 ? 0 : tip_uncertainty(truth, covariance, unknowns, held_out_).rms;
  }

  std::vector<double> tip_errors(const HexapodParameters& truth, const HexapodParameters& model) const {
    std::vector<double> errors;
    Twist error;
    for (const Pose& X_BT : held_out_)
      if (driven_error(truth, model, X_BT, error)) errors.push_back(error.head<3>().norm());
    return errors;
  }

  Answer answer(const Method& method, const Problem& problem, const HexapodParameters& truth,
                const std::vector<double>& uncalibrated) const {
    Answer result;
    const auto start = std::chrono::steady_clock::now();
    const Calibration found = method.estimator->calibrate(problem);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.failure = failure_of(found);
    if (!result.ok()) return result;
    result.errors = tip_errors(truth, found.parameters);
    judge(uncalibrated, result);
    return result;
  }

  TrialSetting setting_;
  const machine::MachineDescription& machine_;
  HexapodGeometry nominal_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  PoseRegion region_;
  std::vector<Pose> held_out_;
};

}  // namespace

std::unique_ptr<TrialRunner> make_hexapod_trials(const TrialSetting& setting) {
  return std::make_unique<HexapodTrials>(setting);
}

}  // namespace understudy::studies
