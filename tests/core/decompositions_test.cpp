// Each held to its definition, or to a matrix whose answer is read off.
#include "core/decompositions.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

Eigen::MatrixXd sample(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd A(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      A(i, j) = std::sin(static_cast<double>(3 * i + 7 * j)) + (i == j ? 2 : 0);
  return A;
}

TEST(Decompositions, LeastNormIsAcrossWhatIsUnseen) {
  Eigen::MatrixXd A(1, 2);
  A << 3, 4;
  const Eigen::VectorXd x = least_norm(A, Eigen::VectorXd::Constant(1, 10));
  EXPECT_NEAR(x[0], 1.2, 1e-14);  // 10 / 25 of each coefficient
  EXPECT_NEAR(x[1], 1.6, 1e-14);
}

TEST(Decompositions, LeastSquaresOfTooManyEquations) {
  Eigen::MatrixXd A(3, 1);
  A << 1, 1, 1;
  EXPECT_NEAR(least_norm(A, Eigen::Vector3d(1, 2, 6))[0], 3, 1e-14);  // the mean
}

TEST(Decompositions, PseudoInverseKeepsPenrosesConditions) {
  const Eigen::MatrixXd A = sample(5, 3), P = pseudo_inverse(A);
  EXPECT_LT((A * P * A - A).norm(), 1e-13);
  EXPECT_LT((P * A * P - P).norm(), 1e-13);
  EXPECT_LT((A * P - (A * P).transpose()).norm(), 1e-13);
  EXPECT_LT((P * A - (P * A).transpose()).norm(), 1e-13);
}

TEST(Decompositions, SingularVectorsTakeTheMatrixApart) {
  const Eigen::MatrixXd A = sample(3, 5);
  const RightSingular right = right_singular(A);
  ASSERT_EQ(right.vectors.cols(), 5);
  EXPECT_LT((A * right.vectors.rightCols(2)).norm(), 1e-13);
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR((A * right.vectors.col(k)).norm(), right.values[k], 1e-13);
  const Eigen::MatrixXd left = left_singular_vectors(A);
  const Eigen::MatrixXd product = left.transpose() * A * right.vectors.leftCols(3);
  EXPECT_LT((product.cwiseAbs() - Eigen::MatrixXd(right.values.asDiagonal())).norm(), 1e-13);
}

TEST(Decompositions, NearestRotationUndoesAStretchAndMirrorsNothing) {
  const Mat3 R = exp_rotation(Vec3(0.3, -1.1, 0.4));
  const Mat3 stretched = R * Vec3(1.1, 0.9, 1.3).asDiagonal();
  EXPECT_LT((nearest_rotation(stretched) - R).norm(), 1e-14);
  EXPECT_NEAR(nearest_rotation(Mat3(Vec3(1, 1, -0.1).asDiagonal())).determinant(), 1, 1e-14);
}

TEST(Decompositions, SymmetricEigenvaluesIncrease) {
  const Mat6 A = sample(6, 6) + sample(6, 6).transpose();
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-12);
  for (Eigen::Index k = 1; k < 6; ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
}

}  // namespace
}  // namespace understudy
