// From points measured on the clamped part to its pose: least squares of their distances from the drawn part,
// with the freedoms that the points do not show left as they are.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "geometry/mesh.h"

namespace understudy::control {

/// A point of the clamped part where the machine's gap sensor saw it.
struct MeasuredPoint {
  Vec3 p_W{0, 0, 0};  ///< [m], as the controller reckons it
  double sigma = 0;   ///< [m], 1 sigma along the normal, of what is this point's own
  /// [m], change of the distance along the normal for 1 sigma of each independent cause that all points
  /// share.
  Eigen::VectorXd common;
};

/// How far the part may stand from where it was drawn, 1 sigma of each coordinate, before it is measured.
struct PartTolerance {
  double position = 0;  ///< [m]
  double rotation = 0;  ///< [rad], about the origin of W
  double size = 0;  ///< a share, about the origin of W: a part that is larger fits worse, which is no fault
};

/// A motion of the part that the points do not tell, or less well than the tolerance does.
struct UnseenFreedom {
  bool turn = false;          ///< else a shift
  Vec3 direction_W{0, 0, 1};  ///< unit, of the shift or of the axis
  Vec3 through_W{0, 0, 0};    ///< [m], a point of the axis
  double sigma = 0;           ///< [m] or [rad], 1 sigma, which the tolerance leaves
};
/// "turn about (0.00 1.00 0.00) through (0.0, 0.0, 15.5) mm".
std::string to_string(const UnseenFreedom& freedom);

struct PartFit {
  /// Moves the drawn part, and all that was programmed on it, to where it stands: p_W = X_W * p_drawn.
  Pose X_W = Pose::Identity();
  Vec3 reference_W{0, 0, 0};  ///< [m], centre of the points: the covariance is told there
  /// Of the error of X_W as a shift of the reference point [m] and a turn [rad], both in W.
  Mat6 covariance = Mat6::Zero();
  int seen = 0;  ///< freedoms that were measured; the others are as they were
  std::vector<UnseenFreedom> unseen;
  std::vector<double> residuals;  ///< [m], of the points off the moved part, positive outside
  double chi_square = 0;          ///< of the residuals
  int degrees_of_freedom = 0;
  double chi_square_limit = 0;  ///< that one right part in 10 000 exceeds; 0 without degrees of freedom
  bool converged = false;

  /// The shape is that of the drawn part, as far as the points can tell.
  bool expected_part() const { return degrees_of_freedom <= 0 || chi_square <= chi_square_limit; }
  /// 1 sigma [m] of the moved part's surface at a point with a unit normal, along that normal.
  double sigma_along(const Vec3& p_W, const Vec3& normal_W) const;
};

/// Gauss-Newton on distances to `drawn` (closed, in W as drawn). A combination of freedoms counts as seen
/// when its standard deviation by the points alone is below that by the tolerance: eigenvalues of the
/// information in units of the tolerance above 1. The tolerance has no part in what is seen. Six points or
/// more, and positive tolerances.
PartFit fit_part(const geometry::Mesh& drawn, const std::vector<MeasuredPoint>& points,
                 const PartTolerance& tolerance);

/// Derivative of a point's distance from the part, positive outside, by a shift of the part and a turn of it
/// about `reference`.
Eigen::Matrix<double, 1, 6> distance_row(const Vec3& p_W, const Vec3& normal_W, const Vec3& reference_W);

/// L of the tolerance's covariance L L^T, as a shift of `reference` and a turn.
Mat6 tolerance_root(const PartTolerance& tolerance, const Vec3& reference_W);

}  // namespace understudy::control
