// Where the plays of a machine are: at rest by the sign of what they carry, or under way across.
//
// Every axis has a gap g in [-b/2, +b/2], positive where the link has run ahead of its drive. A contact only
// pushes: f <= 0 at +b/2, f >= 0 at -b/2, f = 0 between, and friction holds the gap where it is while |f| is
// below it. `load` is the f that keeps all gaps at rest (inverse dynamics). Gaps for which that f is not
// allowed move by
//   M g'' + c g' = f(g) - load,
// M the mass matrix in axis positions. Between stops, ledges and what friction holds, no force jumps: one
// step takes the gaps as far as the first of them meets one. A stop takes all speed away: nothing bounces.
// What stays in touch is stepped implicitly, so nothing here is stiff.
//
// A strut has two plays in series with a body between, the nut. What the nut weighs keeps its own play shut
// until the rod pushes more than that: f(g) has a ledge of that height where one play is used up.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "kinematics/mechanism.h"

namespace understudy::sim {

using kinematics::AxisVector;
using kinematics::column;
using kinematics::elements;
using AxisMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kinematics::kMaxAxes, kinematics::kMaxAxes>;

/// Of one axis; [m] or [rad], [N] or [N m].
struct SeriesPlay {
  double inner = 0;     ///< total travel between the drive and the body between (the nut)
  double outer = 0;     ///< total travel between that body and what it carries
  double friction = 0;  ///< below which the gap stays
  double damping = 0;   ///< while it moves
  double total() const { return inner + outer; }
  /// The gap at which one of the plays is used up. A body between that has to be pushed forwards
  /// (`between` > 0) leans back on the drive; what it carries then reaches the other stop of the outer play
  /// first.
  double ledge(double between) const { return (between > 0 ? 0.5 : -0.5) * (outer - inner); }
};

/// What the drives have to push to keep every gap at rest.
struct AxisLoad {
  AxisVector drive{};  ///< [N] or [N m], at the drive
  AxisVector
      between{};  ///< its part that moves the bodies between the plays; the rest reaches the outer play
};

/// What the body between the plays pushes with, below the ledge and above it.
inline double carried(double between, bool above) {
  return above ? std::min(-between, 0.0) : std::max(-between, 0.0);
}

/// The state of all plays of a machine. Nothing here allocates or throws.
class BacklashDynamics {
 public:
  explicit BacklashDynamics(int axes);

  void set_play(int axis, const SeriesPlay& play);
  const SeriesPlay& play(int axis) const { return plays_[static_cast<std::size_t>(axis)]; }
  /// All gaps in the middle and at rest.
  void centre();

  const AxisVector& gap() const { return gap_; }    ///< [m] or [rad]
  const AxisVector& rate() const { return rate_; }  ///< [m/s] or [rad/s]
  void place(int axis, double gap);                 ///< at rest, clamped to the play

  /// The load leaves every gap where it is.
  bool rests(const AxisLoad& load) const;
  /// Where one gap comes to rest under a constant load: where it is, at a ledge, or at a stop.
  double resting_gap(int axis, const AxisLoad& load) const;
  /// Moves the gaps over `duration` under a constant load; returns the mean force of the drives.
  AxisVector advance(const AxisMatrix& mass, const AxisLoad& load, double duration);

 private:
  struct Row;
  struct Interval;
  struct Flight;
  Row row(int axis, double between, double gap) const;
  double resting_gap(int axis, double needed, double between) const;
  Interval interval(int axis, double between, double direction) const;
  /// Carries the gaps on until one meets an edge, at most over `h`; returns how long [s], 0 for not at all.
  double free_flight(const AxisMatrix& mass, const AxisLoad& load, double h, AxisVector& impulse);
  bool find_moving(const AxisLoad& load, Flight& flight) const;
  bool accelerate(const AxisMatrix& mass, const AxisLoad& load, double h, Flight& flight) const;
  bool hold_pressed(Flight& flight) const;
  bool release_lifted(const AxisMatrix& mass, const AxisLoad& load, Flight& flight,
                      AxisVector& drive_force) const;
  double time_to_edge(Flight& flight, double h) const;
  bool at_stop(int axis) const { return std::abs(gap_[axis]) >= play(axis).total() / 2; }
  void impact(const AxisMatrix& mass, AxisVector& impulse);
  AxisVector impact_change(const AxisMatrix& mass, const kinematics::PerAxis<bool>& free) const;
  /// Over `h` implicitly, whatever is met.
  void substep(const AxisMatrix& mass, const AxisLoad& load, double h, AxisVector& drive_force);

  int axes_;
  kinematics::PerAxis<SeriesPlay> plays_{};
  AxisVector gap_{}, rate_{};
};

}  // namespace understudy::sim
