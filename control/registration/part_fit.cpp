#include "control/registration/part_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/assert.h"
#include "core/cross_matrix.h"
#include "core/decompositions.h"
#include "core/distributions.h"
#include "core/units.h"

namespace understudy::control {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr int kIterations = 50;
constexpr double kConverged = 1e-6;  // of the tolerance: nanometres
constexpr double kSeenAbove = 1;     // information in units of the tolerance
constexpr double kTurnShare = 0.2;   // of a motion at the part's size: less is a shift
constexpr double kRare = 1e-4;       // right parts that are refused

/// Distances of the points from the drawn part, with the part at X_W, and how they change.
struct Linearised {
  Eigen::VectorXd distance;
  Rows rows;
  Eigen::VectorXd growth;  // [m], change of the distance by the part's size
};

Linearised linearise(const geometry::Mesh& drawn, const std::vector<MeasuredPoint>& points, const Pose& X_W,
                     const Vec3& reference) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Linearised at{Eigen::VectorXd(n), Rows(n, 6), Eigen::VectorXd(n)};
  const Pose X_inverse = X_W.inverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 p = X_inverse * points[static_cast<std::size_t>(i)].p_W;
    const geometry::SurfacePoint nearest = drawn.nearest(p);
    const Vec3 normal_W = X_W.linear() * nearest.normal;
    at.distance[i] = drawn.signed_distance(p);
    at.rows.row(i) = distance_row(X_W * nearest.position, normal_W, reference);
    at.growth[i] = -nearest.normal.dot(nearest.position);
  }
  return at;
}

/// What the points are off by, in units of what each has of its own.
struct Noise {
  Eigen::VectorXd own;         // [m]
  Eigen::MatrixXd covariance;  // with what all share, divided by the own sigmas of row and column
};

Noise noise_of(const std::vector<MeasuredPoint>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Noise noise{Eigen::VectorXd(n), Eigen::MatrixXd::Identity(n, n)};
  Eigen::MatrixXd shared(n, points.front().common.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const MeasuredPoint& point = points[static_cast<std::size_t>(i)];
    UNDERSTUDY_ASSERT(point.sigma > 0, "every point has a sigma of its own");
    noise.own[i] = point.sigma;
    if (shared.cols() > 0) shared.row(i) = point.common.transpose() / point.sigma;
  }
  noise.covariance += shared * shared.transpose();
  return noise;
}

/// The freedoms in units of the tolerance, apart by what the points tell of each.
struct Freedoms {
  Mat6 root;             // L
  SymmetricEigen apart;  // of L^T J^T R^-1 J L

  bool seen(Eigen::Index i) const { return apart.values[i] > kSeenAbove; }
  int seen_count() const {
    int count = 0;
    for (Eigen::Index i = 0; i < 6; ++i) count += seen(i);
    return count;
  }
  Eigen::Matrix<double, 6, 1> motion(Eigen::Index i) const { return root * apart.vectors.col(i); }
  /// Eigenvalues increase: the unseen ones come first.
  Rows motions(bool of_seen) const {
    const Eigen::Index k = seen_count();
    const Mat6 all = root * apart.vectors;
    return of_seen ? Rows(all.rightCols(k).transpose()) : Rows(all.leftCols(6 - k).transpose());
  }
};

Freedoms freedoms_of(const Linearised& at, const Noise& noise, const Mat6& root) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(noise.covariance);
  const Eigen::MatrixXd white =
      cholesky.matrixL().solve(noise.own.cwiseInverse().asDiagonal() * (at.rows * root));
  return {root, symmetric_eigen(white.transpose() * white)};
}

Pose turned_about(const Vec3& reference, const Eigen::Matrix<double, 6, 1>& motion) {
  Pose X = Pose::Identity();
  X.linear() = exp_rotation(motion.tail<3>());
  X.translation() = reference + motion.head<3>() - X.linear() * reference;
  return X;
}

/// Least squares along what is seen. The weights are those of each point's own noise: weights of what all
/// points share would make much of small differences between them, which a wrong model gives, too.
struct SeenFit {
  Rows motions;                // rows: what is seen, in units of the tolerance
  Eigen::MatrixXd design;      // of the seen motions, in units of the own noise
  Eigen::MatrixXd inverse;     // pseudo-inverse of the design
  Eigen::MatrixXd covariance;  // of the points in those units, with what the unseen freedoms do
};

SeenFit seen_fit(const Linearised& at, const Noise& noise, const Freedoms& freedoms) {
  const Eigen::MatrixXd rows = noise.own.cwiseInverse().asDiagonal() * at.rows;
  SeenFit fit{freedoms.motions(true), {}, {}, noise.covariance};
  fit.design = rows * fit.motions.transpose();
  fit.inverse = pseudo_inverse(fit.design);
  const Eigen::MatrixXd unseen = rows * freedoms.motions(false).transpose();
  fit.covariance += unseen * unseen.transpose();
  return fit;
}

/// Columns that span the same, each as near as can be to an axis of W.
Eigen::MatrixXd aligned(const Eigen::MatrixXd& basis) {
  Eigen::MatrixXd left = basis * basis.transpose();
  Eigen::MatrixXd result(basis.rows(), basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    Eigen::Index longest = 0;
    left.colwise().norm().maxCoeff(&longest);
    result.col(k) = left.col(longest).normalized();
    left -= result.col(k) * (result.col(k).transpose() * left).eval();
  }
  return result;
}

/// v^T C^-1 v. One kind of decomposition in this source, of matrices of any size: each takes the compiler
/// seconds.
double weighted_square(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& v) {
  return v.dot(covariance.ldlt().solve(v));
}

double sigma_of(const Mat6& covariance, const Eigen::Matrix<double, 6, 1>& unit) {
  return 1 / std::sqrt(weighted_square(covariance, unit));
}

UnseenFreedom shift_along(const Vec3& direction, const Mat6& tolerance) {
  Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Zero();
  unit.head<3>() = direction.normalized();
  return {false, unit.head<3>(), Vec3::Zero(), sigma_of(tolerance, unit)};
}

UnseenFreedom turn_about(const Eigen::Matrix<double, 6, 1>& motion, const Vec3& reference,
                         const Mat6& tolerance) {
  const double angle = motion.tail<3>().norm();
  const Eigen::Matrix<double, 6, 1> unit = motion / angle;
  const Vec3 axis = unit.tail<3>();
  return {true, axis, reference + axis.cross(Vec3(unit.head<3>())), sigma_of(tolerance, unit)};
}

/// Pure shifts first, then turns.
std::vector<UnseenFreedom> name_unseen(const Freedoms& freedoms, const Vec3& reference, double size) {
  Eigen::MatrixXd motions(6, 0);  // shift, and turn as it moves the part's outside
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (freedoms.seen(i)) continue;
    motions.conservativeResize(6, motions.cols() + 1);
    motions.rightCols<1>() = freedoms.motion(i);
    motions.rightCols<1>().tail<3>() *= size;
  }
  std::vector<UnseenFreedom> unseen;
  if (motions.cols() == 0) return unseen;
  const Mat6 tolerance = freedoms.root * freedoms.root.transpose();
  const Eigen::MatrixXd basis = left_singular_vectors(motions);
  const RightSingular turning = right_singular(basis.bottomRows<3>());
  const auto share = [&](Eigen::Index k) { return k < turning.values.size() ? turning.values[k] : 0.0; };
  Eigen::Index turns = 0;
  while (turns < basis.cols() && share(turns) > kTurnShare) ++turns;
  if (const Eigen::Index shifts = basis.cols() - turns; shifts > 0) {
    const Eigen::MatrixXd way = basis.topRows<3>() * turning.vectors.rightCols(shifts);
    const Eigen::MatrixXd directions = aligned(left_singular_vectors(way));
    for (Eigen::Index k = 0; k < shifts; ++k) unseen.push_back(shift_along(directions.col(k), tolerance));
  }
  for (Eigen::Index k = 0; k < turns; ++k) {
    Eigen::Matrix<double, 6, 1> motion = basis * turning.vectors.col(k);
    motion.tail<3>() /= size;
    unseen.push_back(turn_about(motion, reference, tolerance));
  }
  return unseen;
}

/// Of what the best pose leaves. What a part of another size leaves is no sign of another part.
double chi_square_of(const Linearised& at, const Noise& noise, const SeenFit& fit, double size_sigma) {
  const Eigen::Index n = at.distance.size(), k = fit.design.cols();
  if (n <= k) return 0;
  const Eigen::MatrixXd all =
      Eigen::HouseholderQR<Eigen::MatrixXd>(fit.design).householderQ() * Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd beside = all.rightCols(n - k);
  const Eigen::VectorXd growth = size_sigma * at.growth.cwiseQuotient(noise.own);
  const Eigen::VectorXd left = beside.transpose() * at.distance.cwiseQuotient(noise.own);
  const Eigen::MatrixXd covariance =
      beside.transpose() * (fit.covariance + growth * growth.transpose()) * beside;
  return weighted_square(covariance, left);
}

double half_size(const geometry::Mesh& mesh) { return 0.5 * (mesh.upper() - mesh.lower()).norm(); }

std::string triple(const Vec3& v, int digits) {
  const auto tidy = [&](double x) { return std::abs(x) < 0.5 * std::pow(10, -digits) ? 0.0 : x; };
  return fmt::format("({:.{}f}, {:.{}f}, {:.{}f})", tidy(v.x()), digits, tidy(v.y()), digits, tidy(v.z()),
                     digits);
}

}  // namespace

std::string to_string(const UnseenFreedom& freedom) {
  // The same axis whichever way it points.
  Eigen::Index longest = 0;
  freedom.direction_W.cwiseAbs().maxCoeff(&longest);
  const Vec3 direction = freedom.direction_W[longest] < 0 ? Vec3(-freedom.direction_W) : freedom.direction_W;
  if (!freedom.turn) return "shift along " + triple(direction, 2);
  return "turn about " + triple(direction, 2) + " through " + triple(1e3 * freedom.through_W, 1) + " mm";
}

Eigen::Matrix<double, 1, 6> distance_row(const Vec3& p_W, const Vec3& normal_W, const Vec3& reference_W) {
  Eigen::Matrix<double, 1, 6> row;
  row << -normal_W.transpose(), -(p_W - reference_W).cross(normal_W).transpose();
  return row;
}

Mat6 tolerance_root(const PartTolerance& tolerance, const Vec3& reference_W) {
  Mat6 root = Mat6::Zero();
  root.topLeftCorner<3, 3>() = tolerance.position * Mat3::Identity();
  // A turn about the origin shifts the reference.
  root.topRightCorner<3, 3>() = -tolerance.rotation * cross_matrix(reference_W);
  root.bottomRightCorner<3, 3>() = tolerance.rotation * Mat3::Identity();
  return root;
}

double PartFit::sigma_along(const Vec3& p_W, const Vec3& normal_W) const {
  const Eigen::Matrix<double, 1, 6> row = distance_row(p_W, normal_W, reference_W);
  return std::sqrt(std::max(0.0, (row * covariance * row.transpose()).value()));
}

PartFit fit_part(const geometry::Mesh& drawn, const std::vector<MeasuredPoint>& points,
                 const PartTolerance& tolerance) {
  UNDERSTUDY_ASSERT(points.size() >= 6, "a pose has six freedoms");
  UNDERSTUDY_ASSERT(tolerance.position > 0 && tolerance.rotation > 0, "freedoms are told in these units");
  PartFit fit;
  for (const MeasuredPoint& point : points) fit.reference_W += point.p_W;
  fit.reference_W /= static_cast<double>(points.size());
  const Noise noise = noise_of(points);
  const Mat6 root = tolerance_root(tolerance, fit.reference_W);

  Linearised at = linearise(drawn, points, fit.X_W, fit.reference_W);
  Freedoms freedoms = freedoms_of(at, noise, root);
  SeenFit seen = seen_fit(at, noise, freedoms);
  for (int i = 0; i < kIterations && !fit.converged; ++i) {
    const Eigen::VectorXd step = -seen.inverse * at.distance.cwiseQuotient(noise.own);
    fit.X_W = turned_about(fit.reference_W, seen.motions.transpose() * step) * fit.X_W;
    at = linearise(drawn, points, fit.X_W, fit.reference_W);
    freedoms = freedoms_of(at, noise, root);
    seen = seen_fit(at, noise, freedoms);
    fit.converged = step.norm() < kConverged;
  }
  const Rows left_alone = freedoms.motions(false);
  const Eigen::MatrixXd known = seen.motions.transpose() * seen.inverse;
  fit.covariance = known * seen.covariance * known.transpose() + left_alone.transpose() * left_alone;
  fit.seen = freedoms.seen_count();
  fit.unseen = name_unseen(freedoms, fit.reference_W, half_size(drawn));
  fit.residuals.assign(at.distance.begin(), at.distance.end());
  fit.chi_square = chi_square_of(at, noise, seen, tolerance.size);
  fit.degrees_of_freedom = static_cast<int>(points.size()) - fit.seen;
  if (fit.degrees_of_freedom > 0) fit.chi_square_limit = chi_squared_exceeded(fit.degrees_of_freedom, kRare);
  return fit;
}

}  // namespace understudy::control
