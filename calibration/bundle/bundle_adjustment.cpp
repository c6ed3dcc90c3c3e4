#include "calibration/bundle/bundle_adjustment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "calibration/bundle/bundle_equations.h"

namespace understudy::calibration {
namespace {

constexpr std::size_t kLeastPoses = 8;   // seven parameters a strut
constexpr std::size_t kLeastBoards = 2;  // of each camera
constexpr double kStepDone = 1e-6;       // standard deviations: the root of step^T H step
constexpr double kCostRounding = 1e-5;
constexpr double kFirstDamping = 1e-4, kLastDamping = 1e8;

ArrowEquations empty_equations(const BundleProblem& problem) {
  const BundleLayout layout(problem);
  return ArrowEquations(layout.count(), layout.block_sizes());
}

bool finite(const BundlePose& pose) {
  if (!pose.X_BT.matrix().allFinite()) return false;
  for (const auto& camera : pose.targets)
    for (const vision::PixelPoint& target : camera) {
      const double a = target.covariance(0, 0), determinant = target.covariance.determinant();
      if (!target.pixel.allFinite() || !(a > 0) || !(determinant > 0)) return false;
    }
  return std::all_of(pose.displacement.begin(), pose.displacement.end(),
                     [](double d) { return std::isfinite(d); });
}

/// Fills status and message where the data cannot be adjusted.
bool check(const BundleProblem& problem, BundleAdjustment& result) {
  const auto refuse = [&](Status status, std::string message) {
    result.status = status;
    result.message = std::move(message);
    return false;
  };
  for (int camera = 0; camera < 2; ++camera) {
    std::size_t boards = 0;
    for (const vision::SeenBoard& board : problem.boards) {
      if (board.camera != camera) continue;
      ++boards;
      if (board.corners_px.size() != static_cast<std::size_t>(problem.rig.board.corners()))
        return refuse(Status::bad_input,
                      fmt::format("camera {}, layer {}: {} corners, must be {}", camera, board.layer,
                                  board.corners_px.size(), problem.rig.board.corners()));
    }
    if (boards < kLeastBoards)
      return refuse(Status::bad_input,
                    fmt::format("camera {} saw {} boards, must be {} or more", camera, boards, kLeastBoards));
  }
  for (const BundlePose& pose : problem.poses)
    if (!finite(pose))
      return refuse(Status::bad_input,
                    fmt::format("pose {}: a target or a length is no number, or its covariance is not "
                                "positive definite",
                                pose.number));
  if (problem.poses.size() < kLeastPoses)
    return refuse(Status::too_few_poses, fmt::format("{} poses were seen by both cameras, must be {} or more",
                                                     problem.poses.size(), kLeastPoses));
  return true;
}

Eigen::MatrixXd machine_block(const BundleProblem& problem, const Eigen::MatrixXd& shared) {
  const BundleLayout layout(problem);
  const Eigen::Index count = layout.count() - layout.machine();
  return shared.bottomRightCorner(count, count);
}

/// Moves `result` to the least cost; false where the search did not settle.
bool search(const BundleProblem& problem, int max_iterations, BundleAdjustment& result,
            ArrowEquations& equations) {
  if (!gather(problem, result.state, equations)) return false;
  double damping = 0;
  ArrowEquations::Step step;
  for (int tries = 0; tries < max_iterations && damping < kLastDamping; ++tries) {
    ArrowEquations trial_equations = empty_equations(problem);
    BundleState trial;
    const bool solved = equations.solve(damping, step);
    if (solved) trial = moved(problem, result.state, step);
    const bool better = solved && gather(problem, trial, trial_equations) &&
                        trial_equations.cost() <= equations.cost() * (1 + 1e-9) + kCostRounding;
    if (!better) {
      damping = std::max(kFirstDamping, 10 * damping);
      continue;
    }
    result.state = std::move(trial);
    equations = std::move(trial_equations);
    ++result.iterations;
    if (step.curvature < kStepDone * kStepDone && damping <= kFirstDamping) return true;
    damping = damping <= kFirstDamping ? 0 : damping / 10;
  }
  return false;
}

}  // namespace

BundleAdjustment adjust_bundle(const BundleProblem& problem, const Options& options) {
  BundleAdjustment result;
  result.state = start_of(problem);
  if (!check(problem, result)) return result;
  ArrowEquations equations = empty_equations(problem);
  if (!search(problem, options.max_iterations, result, equations)) {
    result.message = fmt::format(
        "the search did not settle after {} iterations: are lengths, pictures and boards of the same rows, "
        "and machine and measuring set-up the right ones?",
        result.iterations);
    return result;
  }
  Eigen::MatrixXd shared;
  if (!equations.covariance(shared)) {
    result.status = Status::rank_deficient;
    result.message = "these poses do not tell all parameters apart: add poses with more tilt";
    return result;
  }
  result.status = Status::ok;
  result.covariance = machine_block(problem, shared);
  result.chi_square = equations.cost();
  result.degrees_of_freedom = equations.equations() - equations.unknowns();
  return result;
}

Eigen::MatrixXd bundle_bound(const BundleProblem& problem, const BundleState& state) {
  ArrowEquations equations = empty_equations(problem);
  Eigen::MatrixXd shared;
  if (!gather(problem, state, equations) || !equations.covariance(shared)) return {};
  return machine_block(problem, shared);
}

}  // namespace understudy::calibration
