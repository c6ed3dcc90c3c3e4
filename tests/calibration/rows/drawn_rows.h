// Rows of measurements of a machine built beside its drawing, drawn with noise.
#pragma once

#include <functional>

#include "calibration/rows/calibrate_rows.h"
#include "core/random.h"
#include "machine/description.h"

namespace understudy::calibration {

constexpr double kDrawnSigma = 50e-6;  // [m]
constexpr double kDrawnTurn = 0.2e-3;  // [rad]

/// A built machine: its parameters of `columns` are off by 0.3 mm and 0.5 mrad, 1 sigma each.
class DrawnRows {
 public:
  DrawnRows(const std::vector<Eigen::Index>& columns, std::uint64_t seed, const std::string& name = "arm");

  static RowMachine nominal_rows(const machine::MachineDescription& machine);

  /// All over a chain's ranges; of a hexapod where docs/reference.md calibrates it.
  std::vector<double> drawn_axes();

  Vec3 noise(double sigma);
  MeasurementRow row(RowKind kind);

  /// Of target `name` at X_TG, seen from the frame.
  void add_in_frame(RowKind kind, const std::string& name, const Pose& X_TG, int count);
  /// Three targets at `count` poses, which their errors have `shared` [m] of in common.
  void add_three_targets(double shared, int count);
  void add_distances(const std::string& anchor, const Vec3& p, double zero, const Vec3& p_TG, int count);

  /// Whether a hexapod's struts have these lengths.
  bool within_struts(const std::vector<double>& lengths) const;

  /// Axes that put `p_TG` where `wanted` is zero: Newton steps of least norm from drawn axes.
  std::vector<double> axes_where(const Vec3& p_TG, const std::function<Eigen::VectorXd(const Vec3&)>& wanted);

  void add_points(const std::string& name, const Vec3& p, const Vec3& p_TG, int count);
  void add_plane(const std::string& name, const Vec3& normal, double offset, const Vec3& p_TG, int count);

  /// (found - built) of the parameters `columns`, in squares by the stated covariance, for each of them.
  double error_squared(const RowCalibration& found, const std::vector<Eigen::Index>& columns);

  Random random;
  machine::MachineDescription description;
  RowMachine nominal, built;
  Pose X_MS;
  RowProblem problem;
};

}  // namespace understudy::calibration
