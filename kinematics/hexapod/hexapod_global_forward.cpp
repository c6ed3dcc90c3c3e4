#include "kinematics/hexapod/hexapod_global_forward.h"

#include <Eigen/LU>

#include <cmath>

namespace understudy::kinematics {
namespace {

constexpr int kMoves = 16;  // from home: 5 mm each for the longest stroke of a desktop machine

bool same_side(const HexapodGeometry& geometry, const Pose& X, double det_home) {
  Mat6 J;
  return jacobian(geometry, X, J) == SolveStatus::ok && J.determinant() * det_home > 0;
}

ForwardResult by_short_moves(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& home,
                             const ForwardOptions& options) {
  ForwardResult result;
  StrutLengths from{}, moved;
  result.status = inverse(geometry, home, from);
  result.X_BT = home;
  int iterations = 0;
  for (int n = 1; n <= kMoves && result.status == SolveStatus::ok; ++n) {
    for (std::size_t i = 0; i < kStruts; ++i)
      moved[i] = n == kMoves ? lengths[i] : from[i] + (lengths[i] - from[i]) * n / kMoves;
    result = forward(geometry, moved, result.X_BT, options);
    iterations += result.iterations;
  }
  result.iterations = iterations;
  return result;
}

}  // namespace

ForwardResult forward_global(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& seed,
                             const Pose& X_BT_home, const ForwardOptions& options) {
  Mat6 J_home;
  const SolveStatus home_status = jacobian(geometry, X_BT_home, J_home);
  if (home_status != SolveStatus::ok) return {home_status};
  const double det_home = J_home.determinant();
  ForwardResult result;
  int iterations = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    result = attempt == 0   ? forward(geometry, lengths, seed, options)
             : attempt == 1 ? forward(geometry, lengths, X_BT_home, options)
                            : by_short_moves(geometry, lengths, X_BT_home, options);
    iterations += result.iterations;
    result.iterations = iterations;
    if (result.status == SolveStatus::bad_input && attempt > 0) return result;
    if (result.status != SolveStatus::ok) continue;
    if (same_side(geometry, result.X_BT, det_home)) return result;
    result.status = SolveStatus::singular;
  }
  return result;
}

}  // namespace understudy::kinematics
