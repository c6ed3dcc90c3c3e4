#include "calibration/estimators/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

constexpr double kStepDone = 1e-7;      // standard deviations: the root of step^T H step
constexpr double kCostRounding = 1e-6;  // at the least
// A step adds up what rounding leaves of hundreds of equations, a cost twice as much of each.
constexpr double kStepRounding = 20, kCostRoundings = 200;
constexpr double kFirstDamping = 1e-4, kLastDamping = 1e8;

bool evaluate(Objective& objective, const HexapodParameters& machine, const std::vector<bool>& used,
              NormalEquations& equations, double& cost) {
  equations.clear();
  cost = 0;
  PoseTerm term;
  for (std::size_t j = 0; j < used.size(); ++j) {
    if (!used[j]) continue;
    if (!objective.term(j, machine, term)) return false;
    equations.add(term.at, term.M, term.v);
    cost += term.cost;
  }
  return std::isfinite(cost);
}

}  // namespace

Fit fit(Objective& objective, const HexapodParameters& start, const Unknowns& unknowns,
        const std::vector<bool>& used, int max_iterations) {
  Fit result{false, start, 0, NormalEquations(unknowns), 0};
  if (!evaluate(objective, start, used, result.equations, result.cost)) return result;
  const double step_done = std::max(kStepDone, kStepRounding * objective.rounding());
  const double cost_rounding = std::max(kCostRounding, kCostRoundings * objective.rounding());
  NormalEquations trial_equations(unknowns);
  double damping = 0;
  ParameterVector step;
  for (int tries = 0; tries < max_iterations && damping < kLastDamping; ++tries) {
    double trial_cost = std::numeric_limits<double>::infinity();
    HexapodParameters trial;
    const bool solved = result.equations.solve(damping, step);
    const double size = solved ? result.equations.curvature(step) : 0;
    if (solved) trial = moved(result.machine, step, unknowns);
    const bool better = solved && evaluate(objective, trial, used, trial_equations, trial_cost) &&
                        trial_cost <= objective.growth() * result.cost + cost_rounding;
    if (!better) {
      damping = std::max(kFirstDamping, 10 * damping);
      continue;
    }
    result.machine = trial;
    result.cost = trial_cost;
    std::swap(result.equations, trial_equations);
    ++result.iterations;
    if (size < step_done * step_done && damping <= kFirstDamping) {
      result.converged = true;
      break;
    }
    damping = damping <= kFirstDamping ? 0 : damping / 10;
  }
  return result;
}

Mat3 inverse_right_jacobian(const Vec3& e) {
  const Mat3 x = cross_matrix(e);
  const double angle = e.norm();
  // (1 / angle^2) (1 - angle/2 cot(angle/2)), by its series where that cancels.
  const double square = angle < 1e-2 ? 1.0 / 12 + angle * angle / 720
                                     : (1 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  return Mat3::Identity() + 0.5 * x + square * x * x;
}

}  // namespace understudy::calibration
