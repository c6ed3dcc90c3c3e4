// The check before any motion (Song 2015, sections 3.4, 3.5 and 5): every limit, along the whole path.
#pragma once

#include <cstddef>
#include <vector>

#include "machine/description.h"
#include "machine/port.h"
#include "toolpath/program.h"

namespace understudy::control {

struct ConstraintFinding {
  kinematics::LimitViolation violation;
  int line = 0;             ///< G-code line, the first where several moves on end break the limit
  int last_line = 0;        ///< the last of these, or `line`
  double time = 0;          ///< [s], planned time of the worst value
  double reduced_feed = 0;  ///< of the programmed feed that is left, below 0.5; 0: not this kind of finding
};

struct ConstraintReport {
  /// One entry for every run of moves in which one part breaks one limit: the worst value met there. Ordered
  /// by line.
  std::vector<ConstraintFinding> findings;
  double duration = 0;                            ///< [s], planned time of the program
  kinematics::AxisVector axis_min{}, axis_max{};  ///< range used, SI
  kinematics::AxisVector velocity_max{};          ///< largest planned axis speed
  kinematics::AxisVector acceleration_max{};      ///< change of speed in a cycle, jumps at corners included
  double condition_worst = 0;
  /// Of the program, ascending: moves that lead to or through poses which no axes reach, or so near a
  /// singular one that axes would leap.
  std::vector<std::size_t> impossible;
};

/// Poses are checked between the programmed points too, at most `step` (and one degree) apart, from home on.
/// Axis speeds and accelerations are those of the planned motion, which never exceeds the limits: it slows
/// down. So an `axis_velocity` finding is a warning, with `reduced_feed` set: a programmed feed (G1) asks an
/// axis for more than twice its limit; value is the speed the feed would need. The other findings are errors.
/// A path that cannot be reached gives findings, not an exception. Where a pose has no axis positions at all
/// the plan ends: `duration` and later findings' times stop there. Bad figures (no feed, a pose that is not
/// finite) throw InputError naming the line.
ConstraintReport check_constraints(const toolpath::Program& program,
                                   const machine::MachineDescription& machine, double step = 0.5e-3);

}  // namespace understudy::control
