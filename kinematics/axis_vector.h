// One value an axis, in the machine's order: positions, rates, forces, plays. Of fixed size, so that a
// control cycle copies it without allocating.
#pragma once

#include <Eigen/Core>
#include <array>

namespace understudy::kinematics {

constexpr int kMaxAxes = 8;

template <typename T>
using PerAxis = std::array<T, kMaxAxes>;

/// [m] or [rad], and per second or per unit as the place says; 0 behind the machine's last axis.
using AxisVector = PerAxis<double>;

/// All of it for arithmetic axis by axis.
inline auto elements(AxisVector& axes) { return Eigen::Map<Eigen::Array<double, kMaxAxes, 1>>(axes.data()); }
inline auto elements(const AxisVector& axes) {
  return Eigen::Map<const Eigen::Array<double, kMaxAxes, 1>>(axes.data());
}

/// The first `count` values for linear algebra.
using AxisColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxAxes, 1>;
inline auto column(AxisVector& axes, int count) { return Eigen::Map<AxisColumn>(axes.data(), count); }
inline auto column(const AxisVector& axes, int count) {
  return Eigen::Map<const AxisColumn>(axes.data(), count);
}

}  // namespace understudy::kinematics
