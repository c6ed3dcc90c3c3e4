#include "sim/strand/strand_beam.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::sim {
namespace {

constexpr double kGauss = 0.5773502691896257;
constexpr int kHalvings = 10;
constexpr int kTrials = 60;

using Vector4 = std::array<double, 4>;

/// Curvature of a cubic element at xi in [-1, 1] from (w, slope) of both ends.
Vector4 curvature(double xi, double l) {
  return {6 * xi / (l * l), (3 * xi - 1) / l, -6 * xi / (l * l), (3 * xi + 1) / l};
}

/// Integral of N'_i N'_j over an element: stiffness of a string under unit tension.
std::array<Vector4, 4> string_stiffness(double l) {
  const double a = 1.2 / l, b = 0.1, c = 2 * l / 15, d = -l / 30;
  return {{{a, b, -a, b}, {b, c, -b, d}, {-a, -b, a, -b}, {b, d, -b, c}}};
}

}  // namespace

BeamString::BeamString(const Section& section, Hold start, Hold end, std::size_t capacity)
    : section_(section), start_(start), end_(end) {
  const std::size_t dofs = 2 * (capacity + 1);
  for (auto* v : {&w_, &next_, &motion_, &slope_forces_, &by_tension_}) v->reserve(dofs);
  matrix_.reserve(dofs);
  moment_.reserve(capacity);
  element_tension_.reserve(capacity);
  relax_.reserve(capacity);
  w_.assign(2, 0.0);
}

void BeamString::append(double slack) {
  w_.push_back(0);
  w_.push_back(0);
  moment_.push_back({0, 0});
  ++elements_;
  element_tension_.push_back(tension_of(elements_ - 1, tension_));
  slack_ += slack;
}

double BeamString::tension_of(std::size_t element, double at_start) const {
  return at_start - section_.load_along * section_.element_length * (static_cast<double>(element) + 0.5);
}

bool BeamString::fixed(std::size_t dof) const {
  if (dof < 2) return dof == 0 || start_ == Hold::clamped;
  if (dof < 2 * elements_) return false;
  return dof % 2 == 0 ? end_ != Hold::free : end_ == Hold::clamped;
}

double BeamString::half_slope_square(const std::vector<double>& w) const {
  const auto k = string_stiffness(section_.element_length);
  double sum = 0;
  for (std::size_t e = 0; e < elements_; ++e)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) sum += 0.5 * w[2 * e + i] * k[i][j] * w[2 * e + j];
  return sum;
}

/// The equations of the step's motion under a given tension, in which it is linear.
void BeamString::assemble(double tension) {
  const double l = section_.element_length, stiffness = section_.modulus * section_.second_moment;
  const auto string = string_stiffness(l);
  const std::size_t dofs = 2 * (elements_ + 1);
  matrix_.assign(dofs, Row{});
  motion_.assign(dofs, 0.0);
  const double q = section_.load_across;
  const Vector4 load{q * l / 2, q * l * l / 12, q * l / 2, -q * l * l / 12};
  for (std::size_t e = 0; e < elements_; ++e) {
    const double pull = tension_of(e, tension);
    for (std::size_t g = 0; g < 2; ++g) {
      const Vector4 b = curvature(g == 0 ? -kGauss : kGauss, l);
      for (std::size_t i = 0; i < 4; ++i) {
        motion_[2 * e + i] -= b[i] * relax_[e] * moment_[e][g] * l / 2;
        for (std::size_t j = 0; j <= i; ++j)
          matrix_[2 * e + i][i - j] += relax_[e] * stiffness * b[i] * b[j] * l / 2;
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      motion_[2 * e + i] += load[i];
      for (std::size_t j = 0; j < 4; ++j) {
        motion_[2 * e + i] -= pull * string[i][j] * w_[2 * e + j];
        if (j <= i) matrix_[2 * e + i][i - j] += pull * string[i][j];
      }
    }
  }
  for (std::size_t i = 0; i < dofs; ++i) {
    if (!fixed(i)) continue;
    motion_[i] = 0;
    for (std::size_t k = 1; k < 4; ++k) {
      matrix_[i][k] = 0;
      if (i + k < dofs) matrix_[i + k][k] = 0;
    }
    matrix_[i][0] = 1;
  }
}

/// string_stiffness of the whole strand times w.
void BeamString::slope_forces(const std::vector<double>& w, std::vector<double>& forces) const {
  const auto k = string_stiffness(section_.element_length);
  forces.assign(w.size(), 0.0);
  for (std::size_t e = 0; e < elements_; ++e)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) forces[2 * e + i] += k[i][j] * w[2 * e + j];
  for (std::size_t i = 0; i < w.size(); ++i)
    if (fixed(i)) forces[i] = 0;
}

/// In place into L D L^T; false where the strand is not stable (a pivot is not positive).
bool BeamString::factorise() {
  for (std::size_t i = 0; i < matrix_.size(); ++i) {
    Row& row = matrix_[i];
    const std::size_t reach = std::min<std::size_t>(3, i);
    for (std::size_t k = reach; k >= 1; --k) {
      const Row& other = matrix_[i - k];
      for (std::size_t m = k + 1; m <= reach; ++m) row[k] -= row[m] * other[m - k];
    }
    for (std::size_t k = reach; k >= 1; --k) {
      const double scaled = row[k] / matrix_[i - k][0];
      row[0] -= row[k] * scaled;
      row[k] = scaled;
    }
    if (!(row[0] > 0)) return false;
  }
  return true;
}

void BeamString::back_substitute(std::vector<double>& x) const {
  const std::size_t n = matrix_.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = std::min<std::size_t>(3, i); k >= 1; --k) x[i] -= matrix_[i][k] * x[i - k];
  for (std::size_t i = 0; i < n; ++i) x[i] /= matrix_[i][0];
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t k = std::min<std::size_t>(3, i); k >= 1; --k) x[i - k] -= matrix_[i][k] * x[i];
}

bool BeamString::step(std::span<const double> creep) {
  double done = 0, share = 1;
  const double smallest = std::ldexp(1.0, -kHalvings);
  while (done < 1) {
    if (try_step(creep, share, slack_ * share)) {
      done += share;
      share = std::min(2 * share, 1 - done);
    } else if ((share /= 2) < smallest) {
      return false;
    }
  }
  slack_ = 0;
  const double most = section_.element_length * static_cast<double>(elements_);
  for (std::size_t i = 0; i <= elements_; ++i)
    if (!(std::abs(deflection(i)) <= most)) return false;
  return true;
}

void BeamString::accept(double tension) {
  const double l = section_.element_length, stiffness = section_.modulus * section_.second_moment;
  for (std::size_t e = 0; e < elements_; ++e) {
    for (std::size_t g = 0; g < 2; ++g) {
      const Vector4 b = curvature(g == 0 ? -kGauss : kGauss, l);
      double change = 0;
      for (std::size_t i = 0; i < 4; ++i) change += b[i] * (next_[2 * e + i] - w_[2 * e + i]);
      moment_[e][g] = relax_[e] * (moment_[e][g] + stiffness * change);
    }
    element_tension_[e] = tension_of(e, tension);
  }
  std::swap(w_, next_);
  tension_ = tension;
}

/// Length that the strand has by its shape beyond what it has by tension and slack, and its derivative; false
/// where it is not stable under this tension. Falls with tension, so that one tension fits.
bool BeamString::surplus(double tension, double length, double& value, double& derivative) {
  assemble(tension);
  if (!factorise()) return false;
  back_substitute(motion_);
  for (std::size_t i = 0; i < w_.size(); ++i) {
    next_[i] = w_[i] + motion_[i];
    if (!std::isfinite(next_[i])) return false;
  }
  if (end_ == Hold::free) return true;
  slope_forces(next_, slope_forces_);
  by_tension_ = slope_forces_;
  back_substitute(by_tension_);
  value = half_slope_square(next_) - length;
  derivative = 0;
  for (std::size_t i = 0; i < w_.size(); ++i) derivative -= slope_forces_[i] * by_tension_[i];
  const double give = section_.element_length / (section_.modulus * section_.area);
  for (std::size_t e = 0; e < elements_; ++e) {
    const double pull = tension_of(e, tension);
    const double relax = pull < 0 && section_.keeps_length ? 1 : relax_[e];
    value -= (pull / relax - element_tension_[e]) * give;
    derivative -= give / relax;
  }
  return std::isfinite(value) && derivative < 0;
}

bool BeamString::try_step(std::span<const double> creep, double share, double slack) {
  relax_.resize(elements_);
  for (std::size_t e = 0; e < elements_; ++e) relax_[e] = 1 / (1 + section_.modulus * creep[e] * share);
  next_.resize(w_.size());
  double value = 0, derivative = -1;
  if (end_ == Hold::free) {
    const double tension = section_.load_along * section_.element_length * static_cast<double>(elements_);
    if (!surplus(tension, 0, value, derivative)) return false;
    accept(tension);
    return true;
  }
  const double length = half_slope_square(w_) + slack;
  double low = -std::numeric_limits<double>::infinity(), high = -low, tension = tension_;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (!surplus(tension, length, value, derivative)) {
      // Buckled: between this tension and the least at which the strand was stable.
      low = tension;
      tension = std::isfinite(high) ? 0.5 * (low + high) : 0.5 * tension;
      continue;
    }
    (value > 0 ? low : high) = tension;
    const double change = -value / derivative;
    double motion = 0, largest = 0;
    for (std::size_t i = 0; i < w_.size(); i += 2) {
      motion = std::max(motion, std::abs(by_tension_[i] * change));
      largest = std::max(largest, std::abs(next_[i]));
    }
    if (motion <= 1e-9 * largest + 1e-18) {
      accept(tension);
      return true;
    }
    tension += change;
    if (!(tension > low && tension < high)) tension = 0.5 * (low + high);
  }
  return false;
}

}  // namespace understudy::sim
