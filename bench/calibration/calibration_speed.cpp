// One calibration from 12 poses by maximum likelihood, ours beside Ceres with automatic differentiation: the
// same data, start and optimum, in one run on one thread. Ours includes its checks of the data.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "bench/calibration/ceres_peer.h"
#include "bench/guarded.h"
#include "calibration/estimators/estimator.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "machine/description.h"

namespace understudy::bench {
namespace {

constexpr int kProblems = 20, kRounds = 15;
constexpr double kSameOptimum = 1e-9;  // [m]
constexpr double kGoal = 5;

std::vector<calibration::Problem> make_problems() {
  using namespace calibration;
  const machine::MachineDescription machine = machine::load_machine("hexapod");
  const auto mechanism = machine.make_mechanism();
  const HexapodGeometry& nominal = machine.hexapod().geometry;
  std::vector<Problem> problems;
  Random random(1, "calibration speed");
  for (int n = 0; n < kProblems; ++n) {
    const HexapodParameters truth{perturbed(nominal, 0.5e-3, random), {}};
    Problem problem{{nominal, {}}, {}};
    for (const Pose& X_BT :
         random_reachable_poses(*mechanism, reference_region(machine.X_BT_home), 12, random)) {
      PoseSample sample;
      if (true_sample(truth, nominal, X_BT, kReferenceNoise, {}, sample))
        problem.samples.push_back(measured(sample, random));
    }
    problems.push_back(problem);
  }
  return problems;
}

double largest_difference(const kinematics::HexapodGeometry& a, const kinematics::HexapodGeometry& b) {
  double worst = 0;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    worst = std::max({worst, (a.base_joint[i] - b.base_joint[i]).cwiseAbs().maxCoeff(),
                      (a.platform_joint[i] - b.platform_joint[i]).cwiseAbs().maxCoeff(),
                      std::abs(a.length_offset[i] - b.length_offset[i])});
  return worst;
}

/// Median over rounds, contenders in turn, of the mean time of a problem [s].
std::vector<double> medians(const std::vector<std::function<void()>>& contenders) {
  std::vector<std::vector<double>> times(contenders.size());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      const auto start = std::chrono::steady_clock::now();
      contenders[c]();
      times[c].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
                         kProblems);
    }
  std::vector<double> result;
  for (auto& t : times) {
    std::nth_element(t.begin(), t.begin() + kRounds / 2, t.end());
    result.push_back(t[kRounds / 2]);
  }
  return result;
}

int run() {
  const std::vector<calibration::Problem> problems = make_problems();
  const auto ours = calibration::make_maximum_likelihood();
  double apart = 0, cost_apart = 0;
  int iterations = 0, peer_iterations = 0, failures = 0;
  for (const calibration::Problem& problem : problems) {
    const calibration::Calibration found = ours->calibrate(problem);
    const CeresAnswer peer = solve_with_ceres(problem, true);
    failures += !found.ok() || !peer.converged;
    apart = std::max(apart, largest_difference(found.parameters.geometry, peer.geometry));
    cost_apart = std::max(cost_apart, std::abs(found.chi_square / peer.cost - 1));
    iterations += found.iterations, peer_iterations += peer.iterations;
  }
  const std::vector<double> t = medians({[&] {
                                           for (const auto& problem : problems) ours->calibrate(problem);
                                         },
                                         [&] {
                                           for (const auto& problem : problems)
                                             solve_with_ceres(problem, true);
                                         },
                                         [&] {
                                           for (const auto& problem : problems)
                                             solve_with_ceres(problem, false);
                                         }});
  std::printf("%d problems of 12 poses, 42 unknowns; %d failed\n", kProblems, failures);
  std::printf("largest difference of a parameter %.1e m (goal %.0e), of the cost %.1e\n", apart, kSameOptimum,
              cost_apart);
  std::printf("iterations: ours %.1f, Ceres %.1f\n", iterations / double{kProblems},
              peer_iterations / double{kProblems});
  std::printf("ours                                  %8.1f us\n", t[0] * 1e6);
  std::printf("Ceres, autodiff, normal equations     %8.1f us   ratio %.1f (goal %.0f)\n", t[1] * 1e6,
              t[1] / t[0], kGoal);
  std::printf("Ceres, autodiff, QR                   %8.1f us   ratio %.1f\n", t[2] * 1e6, t[2] / t[0]);
  const bool met = failures == 0 && apart <= kSameOptimum && t[1] / t[0] >= kGoal;
  std::printf("%s\n", met ? "met" : "missed");
  return met ? 0 : 1;
}

}  // namespace
}  // namespace understudy::bench

int main() { return understudy::bench::guarded("calibration_speed", understudy::bench::run); }
