// Gaps on their way between edges: no force jumps there, so one step of the midpoint rule goes as far as the
// first of them meets an edge.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "sim/plant/quasistatic/backlash_dynamics.h"

namespace understudy::sim {

using kinematics::AxisColumn;

namespace {

// Damping may take half of the speed of the mass that moves with a gap, c h <= m / 2: the midpoint rule errs
// by at most (c h / m)^3 / 12, a hundredth of it. With A = m + c h / 2 that is c h <= 0.4 A.
constexpr double kDamped = 0.4;

// When way(t) = v t + a t^2 / 2 first reaches `distance` >= 0; infinite where it never does.
double first_time(double distance, double v, double a) {
  const double square = v * v + 2 * a * distance;
  if (square < 0) return std::numeric_limits<double>::infinity();
  const double sum = v + std::sqrt(square);
  if (sum > 0) return 2 * distance / sum;
  return a > 0 ? -2 * v / a : std::numeric_limits<double>::infinity();  // away first, from where it stands
}

// The compiler lays out small sizes, and most are: few gaps move at a time.
template <int N>
AxisColumn solve_small(const AxisMatrix& A, AxisColumn& x) {
  const Eigen::Matrix<double, N, N> inverse = Eigen::Matrix<double, N, N>(A).inverse();
  x = (inverse * Eigen::Matrix<double, N, 1>(x)).eval();
  return inverse.diagonal().cwiseInverse();
}

// A x = b with `x` for b, A symmetric and positive definite. Returns what A is for each unknown alone while
// the others, or those after it, follow it freely.
AxisColumn solve(const AxisMatrix& A, AxisColumn& x) {
  switch (A.rows()) {
    case 0:
      return x;
    case 1:
      return solve_small<1>(A, x);
    case 2:
      return solve_small<2>(A, x);
    case 3:
      return solve_small<3>(A, x);
    case 4:
      return solve_small<4>(A, x);
    default:
      break;
  }
  const Eigen::LLT<AxisMatrix> factor(A);
  factor.solveInPlace(x);
  return factor.matrixLLT().diagonal().array().square();
}

}  // namespace

/// Where a gap can go in a direction before another force acts on it.
struct BacklashDynamics::Interval {
  double lower, upper;  // [m] or [rad]
  double force;         // f in it
};

/// Gaps between edges, under forces that do not change.
struct BacklashDynamics::Flight {
  AxisVector direction{};           // of each gap; 0: it rests
  kinematics::PerAxis<int> moving;  // the first `count`
  int count = 0;
  kinematics::PerAxis<Interval> interval;
  AxisVector acceleration{};
  int stops = -1;  // the gap that meets a stop at its end
};

BacklashDynamics::Interval BacklashDynamics::interval(int axis, double between, double direction) const {
  const SeriesPlay& p = play(axis);
  const double ledge = p.ledge(between), half = p.total() / 2;
  const bool forward = direction > 0, above = forward ? gap_[axis] >= ledge : gap_[axis] > ledge;
  return {above ? ledge : -half, above ? half : ledge,
          carried(between, above) + (forward ? -p.friction : p.friction)};
}

// False where one presses on against an edge.
bool BacklashDynamics::find_moving(const AxisLoad& load, Flight& flight) const {
  for (int i = 0; i < axes_; ++i) {
    flight.direction[i] = rate_[i] != 0 ? rate_[i] : resting_gap(i, load) - gap_[i];
    if (flight.direction[i] == 0) continue;
    const Interval s = interval(i, load.between[i], flight.direction[i]);
    if (flight.direction[i] > 0 ? gap_[i] >= s.upper : gap_[i] <= s.lower) return false;
    flight.interval[i] = s;
    flight.moving[flight.count++] = i;
  }
  return true;
}

// M a + c (v + a h / 2) = f - load: the midpoint rule over h. False where damping is too strong for it.
bool BacklashDynamics::accelerate(const AxisMatrix& mass, const AxisLoad& load, double h,
                                  Flight& flight) const {
  AxisMatrix A(flight.count, flight.count);
  AxisColumn a(flight.count);
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    for (int l = 0; l < flight.count; ++l) A(k, l) = mass(i, flight.moving[l]);
    A(k, k) += play(i).damping * h / 2;
    a[k] = flight.interval[i].force - (load.drive[i] - load.between[i]) - play(i).damping * rate_[i];
  }
  const AxisColumn alone = solve(A, a);
  for (int k = 0; k < flight.count; ++k)
    if (!(play(flight.moving[k]).damping * h <= kDamped * alone[k])) return false;
  for (int k = 0; k < flight.count; ++k) flight.acceleration[flight.moving[k]] = a[k];
  return true;
}

// Until another force acts on one of them, at most h.
double BacklashDynamics::time_to_edge(Flight& flight, double h) const {
  const auto end = [&](double time, int stops) {
    if (time > h) return;
    h = time;
    flight.stops = stops;
  };
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    const Interval& s = flight.interval[i];
    const double v = rate_[i], a = flight.acceleration[i], half = play(i).total() / 2;
    const bool turns = (v + a * h) * flight.direction[i] <= 0;
    if (turns && play(i).friction > 0) end(-v / a, -1);
    const double up = s.upper - gap_[i], down = gap_[i] - s.lower;
    const double way = h * (v + a * h / 2), halfway = h * v / 2;  // where it turns, it goes no further
    if (way > up || (turns && halfway > up)) end(first_time(up, v, a), s.upper == half ? i : -1);
    if (-way > down || (turns && -halfway > down)) end(first_time(down, -v, -a), s.lower == -half ? i : -1);
  }
  return h;
}

// Holds those that the others' acceleration presses against the edge where they rest; false if there is none.
bool BacklashDynamics::hold_pressed(Flight& flight) const {
  int count = 0;
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    if (rate_[i] == 0 && flight.acceleration[i] * flight.direction[i] <= 0)
      flight.direction[i] = 0;
    else
      flight.moving[count++] = i;
  }
  const bool some = count != flight.count;
  flight.count = count;
  return some;
}

// Releases those that the others' acceleration lifts from where they rest; false if there is none, and the
// force of the drives is known.
bool BacklashDynamics::release_lifted(const AxisMatrix& mass, const AxisLoad& load, Flight& flight,
                                      AxisVector& drive_force) const {
  const int count = flight.count;
  for (int i = 0; i < axes_; ++i) {
    if (flight.direction[i] != 0) {
      drive_force[i] = flight.interval[i].force + load.between[i];
      continue;
    }
    double needed = load.drive[i] - load.between[i];
    for (int k = 0; k < count; ++k)
      needed += mass(i, flight.moving[k]) * flight.acceleration[flight.moving[k]];
    drive_force[i] = needed + load.between[i];
    const double target = resting_gap(i, needed, load.between[i]);
    if (target == gap_[i]) continue;
    flight.direction[i] = target - gap_[i];
    flight.interval[i] = interval(i, load.between[i], flight.direction[i]);
    flight.moving[flight.count++] = i;
  }
  return flight.count != count;
}

// Stops take the speed of gaps that meet them at once. The others change speed by the mass matrix, or are
// held by their own stops, which only push.
void BacklashDynamics::impact(const AxisMatrix& mass, AxisVector& impulse) {
  kinematics::PerAxis<bool> free{};
  bool some = false;
  for (int i = 0; i < axes_; ++i) {
    const bool into = at_stop(i) && rate_[i] * gap_[i] > 0;
    some = some || into;
    free[i] = !into && (rate_[i] != 0 || !at_stop(i));
  }
  if (!some) return;
  AxisVector change{}, push{};
  bool settled = false;
  for (int round = 0; !settled && round < 2 * axes_; ++round) {
    change = impact_change(mass, free);
    settled = true;
    for (int i = 0; i < axes_; ++i) {
      push[i] = free[i] ? 0 : mass.row(i).dot(column(change, axes_));
      if (!at_stop(i) || play(i).total() == 0) continue;
      const bool wrong = free[i] ? (rate_[i] + change[i]) * gap_[i] > 0 : push[i] * gap_[i] > 0;
      if (!wrong) continue;
      free[i] = !free[i];
      settled = false;
    }
  }
  elements(rate_) += elements(change);
  elements(impulse) += elements(push);
}

// Changes of speed: what is not free stops, and the free ones get no impulse of their own.
AxisVector BacklashDynamics::impact_change(const AxisMatrix& mass,
                                           const kinematics::PerAxis<bool>& free) const {
  AxisVector change{};
  kinematics::PerAxis<int> moving{};
  int count = 0;
  for (int i = 0; i < axes_; ++i) {
    if (free[i])
      moving[count++] = i;
    else
      change[i] = -rate_[i];
  }
  AxisMatrix A(count, count);
  AxisColumn b(count);
  for (int k = 0; k < count; ++k) {
    for (int l = 0; l < count; ++l) A(k, l) = mass(moving[k], moving[l]);
    b[k] = -mass.row(moving[k]).dot(column(change, axes_));
  }
  solve(A, b);
  for (int k = 0; k < count; ++k) change[moving[k]] = b[k];
  return change;
}

// Which gaps move and what they accelerate by depend on each other: an active set, changed until it holds.
double BacklashDynamics::free_flight(const AxisMatrix& mass, const AxisLoad& load, double h,
                                     AxisVector& impulse) {
  Flight flight;
  AxisVector force{};
  if (!find_moving(load, flight)) return 0;
  for (int round = 0;; ++round) {
    if (round == axes_ || !accelerate(mass, load, h, flight)) return 0;
    if (!hold_pressed(flight) && !release_lifted(mass, load, flight, force)) break;
  }
  const double time = time_to_edge(flight, h);
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    const Interval& s = flight.interval[i];
    const double v = rate_[i], a = flight.acceleration[i];
    gap_[i] = std::clamp(gap_[i] + time * (v + a * time / 2), s.lower, s.upper);
    rate_[i] = v + a * time;
  }
  elements(impulse) += time * elements(force);
  if (flight.stops >= 0) {
    double& gap = gap_[flight.stops];
    gap = std::copysign(play(flight.stops).total() / 2, gap);  // what only touches it has no speed to tell
    impact(mass, impulse);
  }
  return time;
}

}  // namespace understudy::sim
