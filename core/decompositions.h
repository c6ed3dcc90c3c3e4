// Decompositions of dense matrices, compiled once: Eigen's take ten seconds and more in each source that has
// them.
#pragma once

#include "core/frames.h"

namespace understudy {

/// x of least norm among those of least |A x - b|, by complete orthogonal decomposition.
Eigen::VectorXd least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Of Moore and Penrose, by complete orthogonal decomposition.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// The left singular vectors, as many as A has rows or columns, whichever is less.
Eigen::MatrixXd left_singular_vectors(const Eigen::MatrixXd& A);

/// All right singular vectors as columns, with the singular values, which decrease.
struct RightSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
RightSingular right_singular(const Eigen::MatrixXd& A);

/// The rotation nearest to M in the sum of squared differences.
Mat3 nearest_rotation(const Mat3& M);

/// Eigenvalues, which increase, and unit eigenvectors as columns.
struct SymmetricEigen {
  Twist values;
  Mat6 vectors;
};
SymmetricEigen symmetric_eigen(const Mat6& symmetric);

}  // namespace understudy
