// The check before any motion (Song 2015, sections 3.4, 3.5 and 5): every limit, along the whole path.
#pragma once

#include <vector>

#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::control {

struct ConstraintFinding {
  kinematics::LimitViolation violation;
  int line = 0;        ///< G-code line
  double time = 0;     ///< [s], planned time
};

struct ConstraintReport {
  /// One entry per line, kind and part: the worst value met there. Ordered by line.
  std::vector<ConstraintFinding> findings;
  double duration = 0;             ///< [s], planned time of the program
  machine::AxisArray axis_min{}, axis_max{};   ///< range used, SI
  machine::AxisArray velocity_max{};           ///< largest planned axis speed
  machine::AxisArray acceleration_max{};
  double condition_worst = 0;
};

/// Poses are checked between the programmed points too, at most `step` apart. Axis speeds and accelerations
/// are those of the planned motion. A path that cannot be reached gives findings, not an exception.
ConstraintReport check_constraints(const toolpath::Program& program, const machine::MachineDescription& machine,
                                   double step = 0.5e-3);

}  // namespace understudy::control
