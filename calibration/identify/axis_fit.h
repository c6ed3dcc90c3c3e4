// What commanded and measured positions of one axis tell of its drive: zero, travel per turn, periodic error,
// lag and play, by least squares.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

namespace understudy::calibration {

/// [m] or [rad], and per second.
struct AxisRow {
  double time = 0;       ///< [s]
  double commanded = 0;  ///< travel of the drive from its reading 0
  double velocity = 0;   ///< commanded
  double measured = 0;   ///< likewise from where the drive's reading 0 is believed to be
};

/// The model, of a row with travel c and velocity v:
///   measured = c + zero + scale c - lag v + sine sin(2 pi c / turn) + cosine (cos(2 pi c / turn) - 1)
///            + side play / 2,   side = +1 or -1.
/// Which side an axis is on is the load's affair, and nothing is assumed of it: rows lie on two lines a play
/// apart, and each belongs to the nearer. Rows on the way from one to the other are left out.
enum class AxisParameter { zero, play, scale, lag, sine, cosine };
constexpr std::size_t kAxisParameters = 6;
const char* to_string(AxisParameter parameter);

struct AxisFitOptions {
  double noise = 0;      ///< [m] or [rad], 1 sigma of a row; above 0
  double turn = 0;       ///< travel in a turn of the motor; 0: no periodic error is looked for
  double around = 0.04;  ///< [s], of a row that is under way: rows so near to it may be too
};

struct AxisFit {
  using Vector = Eigen::Matrix<double, kAxisParameters, 1>;
  using Matrix = Eigen::Matrix<double, kAxisParameters, kAxisParameters>;

  Vector value = Vector::Zero();       ///< 0 where not told
  Matrix covariance = Matrix::Zero();  ///< likewise; by `noise`, and more where chi-square is too large
  std::array<std::string, kAxisParameters> untold{};  ///< why the rows do not tell it; empty: they do
  double chi_square = 0;
  int degrees_of_freedom = 0;
  double residual_rms = 0;  ///< [m] or [rad]
  int rows = 0, left_out = 0, upper = 0, side_changes = 0;

  bool told(AxisParameter p) const { return untold[static_cast<std::size_t>(p)].empty(); }
  double of(AxisParameter p) const { return value[static_cast<Eigen::Index>(p)]; }
  double sigma(AxisParameter p) const;
};

/// Rows as their times increase. With fewer rows than parameters nothing is told.
AxisFit fit_axis(std::span<const AxisRow> rows, const AxisFitOptions& options);

}  // namespace understudy::calibration
