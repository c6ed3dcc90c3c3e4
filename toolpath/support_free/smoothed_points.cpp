#include "toolpath/support_free/smoothed_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace understudy::toolpath {
namespace {

constexpr std::size_t kFewest = 5;  // third differences of fewer say nothing
// Weight of the third differences against the distance moved: at the lightest two neighbours hardly feel each
// other, at the heaviest a parabola goes through some sixty.
constexpr double kLightest = 1e-6, kHeaviest = 1e6;
constexpr int kHalvings = 40;
constexpr double kHeld = 1e6;  // weight of the ends

using Matrix = Eigen::SparseMatrix<double>;

/// D' D, of third differences D.
Matrix roughness(Eigen::Index n) {
  constexpr std::array<double, 4> kThird{-1, 3, -3, 1};
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row + 3 < n; ++row)
    for (Eigen::Index k = 0; k < 4; ++k)
      entries.emplace_back(row, row + k, kThird[static_cast<std::size_t>(k)]);
  Matrix differences(n - 3, n);
  differences.setFromTriplets(entries.begin(), entries.end());
  return Matrix(differences.transpose() * differences);
}

class Smoother {
 public:
  explicit Smoother(const std::vector<Vec3>& points)
      : given_(static_cast<Eigen::Index>(points.size()), 3), roughness_(roughness(given_.rows())) {
    for (Eigen::Index i = 0; i < given_.rows(); ++i) given_.row(i) = points[static_cast<std::size_t>(i)];
  }

  Eigen::MatrixX3d at(double weight) const {
    const Eigen::Index n = given_.rows();
    Eigen::VectorXd held = Eigen::VectorXd::Ones(n);
    held(0) = held(n - 1) = kHeld;
    Matrix system = weight * roughness_;
    for (Eigen::Index i = 0; i < n; ++i) system.coeffRef(i, i) += held(i);
    const Eigen::SimplicialLDLT<Matrix> solver(system);
    Eigen::MatrixX3d smooth = given_;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      smooth.col(axis) = solver.solve(held.cwiseProduct(given_.col(axis)));
    return smooth;
  }
  double moved(const Eigen::MatrixX3d& smooth) const { return (smooth - given_).rowwise().norm().maxCoeff(); }

 private:
  Eigen::MatrixX3d given_;
  Matrix roughness_;
};

}  // namespace

std::vector<Vec3> smoothed_points(const std::vector<Vec3>& points, double tolerance) {
  if (points.size() < kFewest || !(tolerance > 0)) return points;
  const Smoother smoother(points);
  double light = std::log(kLightest), heavy = std::log(kHeaviest);
  Eigen::MatrixX3d best = smoother.at(kHeaviest);
  if (smoother.moved(best) > tolerance) {
    best = smoother.at(kLightest);
    if (smoother.moved(best) > tolerance) return points;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (light + heavy);
      const Eigen::MatrixX3d tried = smoother.at(std::exp(middle));
      const bool within = smoother.moved(tried) <= tolerance;
      (within ? light : heavy) = middle;
      if (within) best = tried;
    }
  }
  std::vector<Vec3> smooth(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) smooth[i] = best.row(static_cast<Eigen::Index>(i));
  smooth.front() = points.front();
  smooth.back() = points.back();
  return smooth;
}

}  // namespace understudy::toolpath
