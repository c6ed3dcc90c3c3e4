// A row against the model: what is left, and how it changes with every unknown.
#pragma once

#include "calibration/rows/surroundings.h"

namespace understudy::calibration {

/// A machine, and what stands around it.
struct RowState {
  RowMachine machine;
  Surroundings around;
};

/// Equations of all rows, then one of each known distance. Of one row: (position, rotation vector), as far as
/// its kind has them; positions [m], turns [rad], both in M.
struct RowEquations {
  Eigen::VectorXd error;  ///< measured less model
  Eigen::MatrixXd
      machine;             ///< d model / d RowMachine::parameters(); no columns where they were not asked for
  Eigen::MatrixXd around;  ///< d model / d SurroundingsLayout::names
};

/// d model / d the machine's `unknowns`, as far as they were asked for, and all of the surroundings.
Eigen::MatrixXd jacobian(const RowEquations& equations, const std::vector<Eigen::Index>& unknowns);

/// First equation of each row, and at the end that of the known distances.
std::vector<Eigen::Index> first_equations(const RowProblem& problem);

RowEquations row_equations(const RowProblem& problem, const SurroundingsLayout& layout, const RowState& at,
                           bool with_machine);

}  // namespace understudy::calibration
