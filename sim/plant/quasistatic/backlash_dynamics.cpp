#include "sim/plant/quasistatic/backlash_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::sim {

using kinematics::AxisColumn;

namespace {

// A load that rises with 1 N/s takes 100 g across 100 um in 40 ms: this resolves it to a few per cent.
constexpr double kSubstep = 0.25e-3;  // [s]
// Gauss-Seidel over the rows: few gaps move at a time, so few sweeps do. A nanometre is a thousandth of what
// a play is known to.
constexpr double kSweepTolerance = 1e-10;  // [m] or [rad]
constexpr int kMaxSweeps = 100;

constexpr double kFlight = 0.02e-3;  // [s]: what flies shorter is in touch with an edge
constexpr double kRounding = 1e-6;   // of an interval

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

/// The force law of one axis about its present gap: level(g), falling in steps from -b/2 to +b/2.
struct BacklashDynamics::Row {
  std::array<double, 4> edge;   ///< -b/2, two ledges in order, +b/2
  std::array<double, 3> level;  ///< at the outer play, between the edges

  /// The g at which slope * (g - centre) = f(g).
  double solve(double slope, double centre) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double g = centre + level[k] / slope;
      if (g <= edge[k]) return edge[k];
      if (g < edge[k + 1]) return g;
    }
    return edge[3];
  }
};

BacklashDynamics::BacklashDynamics(int axes) : axes_(axes) {}

void BacklashDynamics::set_play(int axis, const SeriesPlay& play) {
  plays_[axis] = play;
  gap_[axis] = std::clamp(gap_[axis], -play.total() / 2, play.total() / 2);
}

void BacklashDynamics::centre() { gap_ = rate_ = {}; }

void BacklashDynamics::place(int axis, double gap) {
  const double half = play(axis).total() / 2;
  gap_[axis] = std::clamp(gap, -half, half);
  rate_[axis] = 0;
}

BacklashDynamics::Row BacklashDynamics::row(int axis, double between, double gap) const {
  const SeriesPlay& p = play(axis);
  const double ledge = p.ledge(between);
  const auto level = [&](double g) {
    return carried(between, g >= ledge) + (g < gap ? p.friction : -p.friction);
  };
  Row row;
  row.edge = {-p.total() / 2, std::min(ledge, gap), std::max(ledge, gap), p.total() / 2};
  for (std::size_t k = 0; k < 3; ++k) row.level[k] = level((row.edge[k] + row.edge[k + 1]) / 2);
  return row;
}

bool BacklashDynamics::rests(const AxisLoad& load) const {
  for (int i = 0; i < axes_; ++i)
    if (rate_[i] != 0 || resting_gap(i, load) != gap_[i]) return false;
  return true;
}

double BacklashDynamics::resting_gap(int axis, const AxisLoad& load) const {
  return resting_gap(axis, load.drive[axis] - load.between[axis], load.between[axis]);
}

double BacklashDynamics::resting_gap(int axis, double needed, double between) const {
  const SeriesPlay& p = play(axis);
  if (p.total() <= 0) return 0;
  const double gap = gap_[axis], half = p.total() / 2, ledge = p.ledge(between);
  const double pushed = carried(between, false), pulled = carried(between, true);
  // f may lie between the levels on both sides of the gap, widened by friction.
  const double above = gap >= half ? -kInfinity : (gap >= ledge ? pulled : pushed) - p.friction;
  const double below = gap <= -half ? kInfinity : (gap <= ledge ? pushed : pulled) + p.friction;
  if (needed > below) return gap > ledge && needed <= pushed + p.friction ? ledge : -half;
  if (needed < above) return gap < ledge && needed >= pulled - p.friction ? ledge : half;
  return gap;
}

void BacklashDynamics::substep(const AxisMatrix& mass, const AxisLoad& load, double h,
                               AxisVector& drive_force) {
  AxisMatrix A = mass / (h * h);
  for (int i = 0; i < axes_; ++i) A(i, i) += play(i).damping / h;
  const AxisColumn momentum = mass * (column(gap_, axes_) + h * column(rate_, axes_)) / (h * h);
  kinematics::PerAxis<Row> rows;
  AxisVector fixed{};
  for (int i = 0; i < axes_; ++i) {
    const double drag = play(i).damping / h;
    fixed[i] = momentum[i] + drag * gap_[i] - (load.drive[i] - load.between[i]);
    rows[i] = row(i, load.between[i], gap_[i]);
  }
  AxisVector next;
  for (int i = 0; i < axes_; ++i)
    next[i] = std::clamp(gap_[i] + h * rate_[i], rows[i].edge.front(), rows[i].edge.back());
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0;
    for (int i = 0; i < axes_; ++i) {
      double all = A(i, 0) * next[0];  // in the order of the axes
      for (int k = 1; k < axes_; ++k) all += A(i, k) * next[k];
      const double others = fixed[i] - all + A(i, i) * next[i];
      const double g = rows[i].solve(A(i, i), others / A(i, i));
      change = std::max(change, std::abs(g - next[i]));
      next[i] = g;
    }
    if (change < kSweepTolerance * h / kSubstep) break;
  }
  column(drive_force, axes_) = A * column(next, axes_) - column(fixed, axes_) + column(load.between, axes_);
  column(rate_, axes_) = (column(next, axes_) - column(gap_, axes_)) / h;
  gap_ = next;
}

AxisVector BacklashDynamics::advance(const AxisMatrix& mass, const AxisLoad& load, double duration) {
  AxisVector impulse{}, force{};
  const double least = kRounding * duration;
  for (double left = duration; left > least;) {
    if (rests(load)) {
      elements(impulse) += left * elements(load.drive);
      break;
    }
    const double flown = free_flight(mass, load, left, impulse);
    left -= flown;
    if (flown >= kFlight || left <= least) continue;
    const double h = std::min(left, kSubstep);
    substep(mass, load, h, force);
    elements(impulse) += h * elements(force);
    impact(mass, impulse);
    left -= h;
  }
  elements(impulse) /= duration;
  return impulse;
}

}  // namespace understudy::sim
