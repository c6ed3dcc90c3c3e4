#include "sim/plant/quasistatic/backlash_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace understudy::sim {

using kinematics::AxisColumn;

namespace {

// A load that rises with 1 N/s takes 100 g across 100 um in 40 ms: this resolves it to a few per cent.
constexpr double kSubstep = 0.25e-3;  // [s]
// Gauss-Seidel over the rows: few gaps move at a time, so few sweeps do. A nanometre is a thousandth of what
// a play is known to.
constexpr double kSweepTolerance = 1e-10;  // [m] or [rad]
constexpr int kMaxSweeps = 100;

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

/// What all steps of an interval share.
struct BacklashDynamics::Interval {
  const AxisMatrix& mass;
  double h;      // [s], of a step
  AxisMatrix A;  // of the implicit step: mass / h^2, and the damping / h on the diagonal
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
  // A body between that has to be pushed forwards (between > 0) leans back on the drive; what it carries
  // then reaches the other stop of the outer play first.
  const double ledge = (between > 0 ? 0.5 : -0.5) * (p.outer - p.inner);
  const auto level = [&](double g) {
    const double carried = g < ledge ? std::max(-between, 0.0) : std::min(-between, 0.0);
    return carried + (g < gap ? p.friction : -p.friction);
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
  const SeriesPlay& p = play(axis);
  if (p.total() <= 0) return 0;
  const double gap = gap_[axis], between = load.between[axis], needed = load.drive[axis] - between;
  const double half = p.total() / 2;
  const double ledge = (between > 0 ? 0.5 : -0.5) * (p.outer - p.inner);
  const double pushed = std::max(-between, 0.0), pulled = std::min(-between, 0.0);
  // f may lie between the levels on both sides of the gap, widened by friction.
  const double above = gap >= half ? -kInfinity : (gap >= ledge ? pulled : pushed) - p.friction;
  const double below = gap <= -half ? kInfinity : (gap <= ledge ? pushed : pulled) + p.friction;
  if (needed > below) return gap > ledge && needed <= pushed + p.friction ? ledge : -half;
  if (needed < above) return gap < ledge && needed >= pulled - p.friction ? ledge : half;
  return gap;
}

void BacklashDynamics::substep(const Interval& interval, const AxisLoad& load, AxisVector& drive_force) {
  const auto& [mass, h, A] = interval;
  const AxisColumn momentum = mass * (column(gap_, axes_) + h * column(rate_, axes_)) / (h * h);
  kinematics::PerAxis<Row> rows;
  AxisVector fixed{};
  for (int i = 0; i < axes_; ++i) {
    const double drag = play(i).damping / h;
    fixed[i] = momentum[i] + drag * gap_[i] - (load.drive[i] - load.between[i]);
    rows[i] = row(i, load.between[i], gap_[i]);
  }
  AxisVector next = gap_;
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
    if (change < kSweepTolerance) break;
  }
  column(drive_force, axes_) = A * column(next, axes_) - column(fixed, axes_) + column(load.between, axes_);
  column(rate_, axes_) = (column(next, axes_) - column(gap_, axes_)) / h;
  gap_ = next;
}

BacklashDynamics::Interval BacklashDynamics::implicit_step(const AxisMatrix& mass, double h) const {
  Interval interval{mass, h, mass / (h * h)};
  for (int i = 0; i < axes_; ++i) interval.A(i, i) += play(i).damping / h;
  return interval;
}

AxisVector BacklashDynamics::advance(const AxisMatrix& mass, const AxisLoad& load, double duration) {
  const int count = std::max(1, static_cast<int>(std::ceil(duration / kSubstep - 1e-9)));
  AxisVector sum{}, force{};
  std::optional<Interval> interval;
  for (int k = 0; k < count; ++k) {
    if (rests(load)) {
      elements(sum) += elements(load.drive);
    } else {
      if (!interval) interval.emplace(implicit_step(mass, duration / count));
      substep(*interval, load, force);
      elements(sum) += elements(force);
    }
  }
  elements(sum) /= count;
  return sum;
}

}  // namespace understudy::sim
