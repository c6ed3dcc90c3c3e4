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
struct BacklashDynamics::Stretch {
  double lower, upper;  // [m] or [rad]
  double force;         // f in it
};

/// Gaps between edges, under forces that do not change.
struct BacklashDynamics::Flight {
  AxisVector direction{};           // of each gap; 0: it rests
  kinematics::PerAxis<int> moving;  // the first `count`
  int count = 0;
  kinematics::PerAxis<Stretch> stretch;
  AxisVector acceleration{};
  int lands = -1;  // the gap that meets a stop at its end
};

BacklashDynamics::Stretch BacklashDynamics::stretch(int axis, double between, double direction) const {
  const SeriesPlay& p = play(axis);
  const double ledge = p.ledge(between), half = p.total() / 2;
  const bool forward = direction > 0, above = forward ? gap_[axis] >= ledge : gap_[axis] > ledge;
  return {above ? ledge : -half, above ? half : ledge,
          carried(between, above) + (forward ? -p.friction : p.friction)};
}

// False where one presses on against an edge.
bool BacklashDynamics::set_out(const AxisLoad& load, Flight& flight) const {
  for (int i = 0; i < axes_; ++i) {
    flight.direction[i] = rate_[i] != 0 ? rate_[i] : resting_gap(i, load) - gap_[i];
    if (flight.direction[i] == 0) continue;
    const Stretch s = stretch(i, load.between[i], flight.direction[i]);
    if (flight.direction[i] > 0 ? gap_[i] >= s.upper : gap_[i] <= s.lower) return false;
    flight.stretch[i] = s;
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
    a[k] = flight.stretch[i].force - (load.drive[i] - load.between[i]) - play(i).damping * rate_[i];
  }
  const AxisColumn alone = solve(A, a);
  for (int k = 0; k < flight.count; ++k)
    if (!(play(flight.moving[k]).damping * h <= kDamped * alone[k])) return false;
  for (int k = 0; k < flight.count; ++k) flight.acceleration[flight.moving[k]] = a[k];
  return true;
}

// Until another force acts on one of them, at most h.
double BacklashDynamics::time_to_edge(Flight& flight, double h) const {
  const auto end = [&](double time, int lands) {
    if (time > h) return;
    h = time;
    flight.lands = lands;
  };
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    const Stretch& s = flight.stretch[i];
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

// What the others' acceleration presses against the edge where it rests.
bool BacklashDynamics::let_rest(Flight& flight) const {
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

// What the others' acceleration lifts from where it rests. The force of the drives, if nothing.
bool BacklashDynamics::let_go(const AxisMatrix& mass, const AxisLoad& load, Flight& flight,
                              AxisVector& drive_force) const {
  const int count = flight.count;
  for (int i = 0; i < axes_; ++i) {
    if (flight.direction[i] != 0) {
      drive_force[i] = flight.stretch[i].force + load.between[i];
      continue;
    }
    double needed = load.drive[i] - load.between[i];
    for (int k = 0; k < count; ++k)
      needed += mass(i, flight.moving[k]) * flight.acceleration[flight.moving[k]];
    drive_force[i] = needed + load.between[i];
    const double target = resting_gap(i, needed, load.between[i]);
    if (target == gap_[i]) continue;
    flight.direction[i] = target - gap_[i];
    flight.stretch[i] = stretch(i, load.between[i], flight.direction[i]);
    flight.moving[flight.count++] = i;
  }
  return flight.count != count;
}

// Stops take the speed of gaps that meet them at once. Others are thrown by what their masses have in common,
// or held by their own stops, which only push.
void BacklashDynamics::land(const AxisMatrix& mass, AxisVector& impulse) {
  kinematics::PerAxis<bool> free{};
  bool lands = false;
  for (int i = 0; i < axes_; ++i) {
    const bool into = at_stop(i) && rate_[i] * gap_[i] > 0;
    lands = lands || into;
    free[i] = !into && (rate_[i] != 0 || !at_stop(i));
  }
  if (!lands) return;
  AxisVector change{}, push{};
  bool settled = false;
  for (int round = 0; !settled && round < 2 * axes_; ++round) {
    change = thrown(mass, free);
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
AxisVector BacklashDynamics::thrown(const AxisMatrix& mass, const kinematics::PerAxis<bool>& free) const {
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

// A gap that sets out may press others against their edges or lift them from there, which lets them rest or
// go in turn.
double BacklashDynamics::fly(const AxisMatrix& mass, const AxisLoad& load, double h, AxisVector& impulse) {
  Flight flight;
  AxisVector force{};
  if (!set_out(load, flight)) return 0;
  for (int round = 0;; ++round) {
    if (round == axes_ || !accelerate(mass, load, h, flight)) return 0;
    if (!let_rest(flight) && !let_go(mass, load, flight, force)) break;
  }
  const double time = time_to_edge(flight, h);
  for (int k = 0; k < flight.count; ++k) {
    const int i = flight.moving[k];
    const Stretch& s = flight.stretch[i];
    const double v = rate_[i], a = flight.acceleration[i];
    gap_[i] = std::clamp(gap_[i] + time * (v + a * time / 2), s.lower, s.upper);
    rate_[i] = v + a * time;
  }
  elements(impulse) += time * elements(force);
  if (flight.lands >= 0) {
    gap_[flight.lands] = std::copysign(play(flight.lands).total() / 2, rate_[flight.lands]);
    land(mass, impulse);
  }
  return time;
}

}  // namespace understudy::sim
