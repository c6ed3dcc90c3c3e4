#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "calibration/estimators/chain_calibration.h"
#include "core/error.h"
#include "sim/as_built/as_built.h"
#include "studies/calibration/calibration_trial.h"
#include "studies/calibration/disturbance.h"

namespace understudy::studies {
namespace {

using namespace calibration;

constexpr double kMiddleShare = 0.5;  // of each axis's range, about its middle

class ChainTrials : public TrialRunner {
 public:
  explicit ChainTrials(const TrialSetting& setting)
      : setting_(setting),
        machine_(*setting.machine),
        description_(machine_.chain().kinematics),
        nominal_{description_.chain, {}} {
    Random random(setting.seed, "calibration benchmark/held-out readings");
    for (std::size_t n = 0; n < setting.held_out; ++n) held_out_.push_back(readings(random));
  }

  Trial run(const Condition& condition, int machine, renderer::CalibrationView*) const override {
    const auto built =
        sim::make_as_built(machine_, "manufactured", setting_.seed + static_cast<std::uint64_t>(machine));
    ChainParameters truth{built.chain, {}};
    for (std::size_t i = 0; i < built.chain.axes.size(); ++i) truth.zero.push_back(built.axis_zero[i]);
    const std::vector<ChainSample> exact = exact_samples(condition, machine, truth, built.axis_play);
    Trial trial;
    trial.uncalibrated = tip_errors(truth, nominal_);
    trial.bound = bound(truth, exact);
    const ChainProblem problem{nominal_, measured_samples(condition, machine, exact)};
    for (const Method& method : setting_.entrants)
      trial.answers.push_back(answer(method, problem, truth, trial.uncalibrated));
    return trial;
  }

 private:
  Answer answer(const Method& method, const ChainProblem& problem, const ChainParameters& truth,
                const std::vector<double>& uncalibrated) const {
    Answer result;
    const auto start = std::chrono::steady_clock::now();
    const ChainCalibration found = method.estimator->calibrate_chain(problem);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.failure = failure_of(found);
    if (!result.ok()) return result;
    result.errors = tip_errors(truth, found.parameters);
    judge(uncalibrated, result);
    return result;
  }

  Random stream(const char* purpose, const Condition& condition, int machine) const {
    return {setting_.seed, fmt::format("calibration benchmark/{}/{}/{}/{}", purpose, machine, condition.poses,
                                       to_string(condition.disturbance))};
  }

  std::vector<double> readings(Random& random) const {
    std::vector<double> q;
    for (const auto& axis : description_.chain.axes) {
      const double middle = 0.5 * (axis.lower + axis.upper), half = 0.5 * (axis.upper - axis.lower);
      q.push_back(std::isfinite(half) ? middle + kMiddleShare * half * random.uniform(-1, 1)
                                      : random.uniform(-1, 1));
    }
    return q;
  }

  /// Every axis stands at either end of its play; what is measured is where the tool really is.
  std::vector<ChainSample> exact_samples(const Condition& condition, int machine,
                                         const ChainParameters& truth,
                                         const kinematics::AxisVector& play) const {
    Random poses(setting_.seed,
                 fmt::format("calibration benchmark/readings/{}/{}", machine, condition.poses));
    Random random = stream("play", condition, machine);
    std::vector<ChainSample> samples(condition.poses);
    for (ChainSample& sample : samples) {
      sample.axes = readings(poses);
      std::vector<double> real = sample.axes;
      for (std::size_t i = 0; condition.disturbance == Disturbance::play && i < real.size(); ++i)
        real[i] += (random.uniform() < 0.5 ? -0.5 : 0.5) * play[i];
      sample.X_ST = forward(truth, real);
      sample.covariance = condition.noise.covariance();
    }
    return samples;
  }

  std::vector<ChainSample> measured_samples(const Condition& condition, int machine,
                                            std::vector<ChainSample> samples) const {
    Random random = stream("noise", condition, machine), wrong = stream("wrong", condition, machine);
    const FrameError frame(machine_.X_BT_home.translation(), wrong);
    const std::size_t outliers =
        condition.disturbance == Disturbance::outliers ? outlier_count(samples.size()) : 0;
    for (std::size_t j = 0; j < samples.size();
         ++j) {  // poses are random: the first ones may be the wrong ones
      PoseSample sample;
      sample.X_BT = samples[j].X_ST;
      sample.covariance = samples[j].covariance;
      sample = measured(sample, random);
      if (j < outliers) {
        sample.covariance = kOutlier.covariance();
        sample = measured(sample, wrong);
      }
      samples[j].X_ST = condition.disturbance == Disturbance::boards ? frame.seen(sample.X_BT) : sample.X_BT;
    }
    return samples;
  }

  /// The redundant parameters move nothing, so the pseudo-inverse tells the tip's bound.
  double bound(const ChainParameters& truth, const std::vector<ChainSample>& exact) const {
    Eigen::MatrixXd H;
    for (const ChainSample& sample : exact) {
      const Eigen::MatrixXd G = chain_rows(truth, sample.axes);
      const Eigen::MatrixXd term = G.transpose() * sample.covariance.llt().solve(G);
      H = H.size() == 0 ? term : Eigen::MatrixXd(H + term);
    }
    // Metres and radians are told apart by their own sizes.
    const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(scale.asDiagonal() * H * scale.asDiagonal());
    const Eigen::VectorXd& values = parts.eigenvalues();
    Eigen::VectorXd inverse = Eigen::VectorXd::Zero(values.size());
    for (Eigen::Index k = 0; k < values.size(); ++k)
      if (values[k] > 1e-10 * values[values.size() - 1]) inverse[k] = 1 / values[k];
    const Eigen::MatrixXd root = scale.asDiagonal() * parts.eigenvectors() * inverse.cwiseSqrt().asDiagonal();
    double squares = 0;
    for (const auto& q : held_out_) squares += (chain_rows(truth, q).topRows(3) * root).squaredNorm();
    return std::sqrt(squares / static_cast<double>(held_out_.size()));
  }

  /// Where the model believes the tip to be, less where it is.
  std::vector<double> tip_errors(const ChainParameters& truth, const ChainParameters& model) const {
    std::vector<double> errors;
    for (const auto& q : held_out_)
      errors.push_back((forward(model, q).translation() - forward(truth, q).translation()).norm());
    return errors;
  }

  TrialSetting setting_;
  const machine::MachineDescription& machine_;
  const kinematics::ChainDescription& description_;
  ChainParameters nominal_;
  std::vector<std::vector<double>> held_out_;
};

}  // namespace

std::unique_ptr<TrialRunner> make_chain_trials(const TrialSetting& setting) {
  if (setting.stand)
    throw InputError(
        fmt::format("--from pixels: the two cameras are made for a hexapod's platform, and {} is none",
                    setting.machine->name));
  return std::make_unique<ChainTrials>(setting);
}

}  // namespace understudy::studies
