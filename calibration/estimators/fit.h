// Gauss-Newton on the parameters, with Levenberg's damping only where a whole step makes things worse. How
// poses are weighed is the Objective's choice and all that tells the estimators apart.
#pragma once

#include <span>

#include "calibration/estimators/normal_equations.h"

namespace understudy::calibration {

/// What one sample adds: cost = its share, M and v as NormalEquations::add() takes them.
struct PoseTerm {
  StrutLinearisation at;
  Mat6 M;
  Vec6 v;
  double cost;
};

class Objective {
 public:
  virtual ~Objective() = default;
  /// False where the model has no answer for sample j. Costs are dimensionless, about 1 per equation.
  virtual bool term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) = 0;
  /// By what factor a good step may raise the cost: above 1 where weights move with the parameters.
  virtual double growth() const { return 1 + 1e-9; }
  /// What rounding leaves of an equation, in standard deviations: no step can be told from 0 below it.
  virtual double rounding() const { return 0; }
};

struct Fit {
  bool converged = false;
  HexapodParameters machine;
  int iterations = 0;
  NormalEquations equations;  ///< at `machine`
  double cost = 0;
};

/// Over the samples with used[j]. Converged once a step is below 1e-7 of the parameters' standard deviations,
/// or below what rounding allows to know.
Fit fit(Objective& objective, const HexapodParameters& start, const Unknowns& unknowns,
        const std::vector<bool>& used, int max_iterations);

/// d (log of exp(e) exp(-w)) / dw at w = 0, less its sign: 1 + e x / 2 + ...
Mat3 inverse_right_jacobian(const Vec3& e);

}  // namespace understudy::calibration
