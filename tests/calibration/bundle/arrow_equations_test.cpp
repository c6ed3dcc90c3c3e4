#include "calibration/bundle/arrow_equations.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/random.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(Index rows, Index columns, Random& random) {
  MatrixXd m(rows, columns);
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j) m(i, j) = random.normal();
  return m;
}

/// The same equations, block by block and in one dense matrix.
struct Both {
  explicit Both(std::uint64_t seed) : arrow(4, std::vector<Index>{2, 3}) {
    Random random(seed, "arrow equations");
    const Index first[] = {4, 6};
    const Index size[] = {2, 3};
    for (std::size_t block = 0; block < 2; ++block)
      for (const std::vector<Index>& columns : {std::vector<Index>{0, 2}, std::vector<Index>{3, 1, 2}}) {
        const MatrixXd by_shared = random_matrix(5, static_cast<Index>(columns.size()), random);
        const MatrixXd by_local = random_matrix(5, size[block], random);
        const VectorXd residual = random_matrix(5, 1, random);
        arrow.add(residual, columns, by_shared, block, by_local);
        MatrixXd J = MatrixXd::Zero(5, 9);
        for (std::size_t k = 0; k < columns.size(); ++k)
          J.col(columns[k]) = by_shared.col(static_cast<Index>(k));
        J.middleCols(first[block], size[block]) = by_local;
        H += J.transpose() * J;
        g += J.transpose() * residual;
        cost += residual.squaredNorm();
      }
    arrow.add_prior(1, 0.3, 2);
    H(1, 1) += 4, g[1] += 4 * 0.3, cost += 4 * 0.09;
    arrow.add_local_prior(1, 2, -0.5, 3);
    H(8, 8) += 9, g[8] -= 9 * 0.5, cost += 9 * 0.25;
  }
  ArrowEquations arrow;
  MatrixXd H = MatrixXd::Zero(9, 9);
  VectorXd g = VectorXd::Zero(9);
  double cost = 0;
};

// 1e-10: rounding of some hundred products of numbers of size 1 and a condition below 1e3.
TEST(ArrowEquations, SolvesAsTheDenseNormalEquationsDo) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double damping : {0.0, 0.7}) {
      const Both both(seed);
      MatrixXd H = both.H;
      H.diagonal() *= 1 + damping;
      const VectorXd expected = H.ldlt().solve(-both.g);
      ArrowEquations::Step step;
      ASSERT_TRUE(both.arrow.solve(damping, step)) << seed;
      VectorXd found(9);
      found << step.shared, step.local[0], step.local[1];
      EXPECT_LT((found - expected).norm(), 1e-10) << seed;
      EXPECT_NEAR(step.curvature, expected.dot(both.H * expected), 1e-9) << seed;
    }
}

TEST(ArrowEquations, CovarianceIsTheSharedBlockOfTheInverse) {
  const Both both(7);
  MatrixXd shared;
  ASSERT_TRUE(both.arrow.covariance(shared));
  EXPECT_LT((shared - both.H.inverse().topLeftCorner<4, 4>()).norm(), 1e-10);
  EXPECT_NEAR(both.arrow.cost(), both.cost, 1e-12);
  EXPECT_EQ(both.arrow.equations(), 22);
  EXPECT_EQ(both.arrow.unknowns(), 9);
}

TEST(ArrowEquations, AnUnknownThatNoEquationHasIsNoAnswer) {
  ArrowEquations arrow(2, std::vector<Index>{1});
  arrow.add(VectorXd::Ones(3), std::vector<Index>{0}, MatrixXd::Ones(3, 1), 0, VectorXd::LinSpaced(3, 0, 1));
  MatrixXd shared;
  ArrowEquations::Step step;
  EXPECT_FALSE(arrow.covariance(shared));
  EXPECT_FALSE(arrow.solve(0, step));
}

}  // namespace
}  // namespace understudy::calibration
