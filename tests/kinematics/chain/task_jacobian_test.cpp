#include "kinematics/chain/task_jacobian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/SVD>

#include "core/random.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::kinematics {
namespace {

// Three dimensions of task by four axes: two axes share the first, one makes each of the others.
TaskJacobian four_axes(double last) {
  TaskJacobian J = TaskJacobian::Zero(3, 4);
  J << 1, 1, 0, 0,  //
      0, 0, 2, 0,   //
      0, 0, 0, last;
  return J;
}

TEST(TaskJacobian, EqualAxesShareAVelocityEqually) {
  AxisColumn y;
  ASSERT_TRUE(solve_minimum_norm(four_axes(4), Eigen::Vector3d(1, 1, 1), y));
  // By hand: of all y with y1 + y2 = 1 the shortest has two halves. Rounding of numbers near 1.
  EXPECT_TRUE(y.isApprox(Eigen::Vector4d(0.5, 0.5, 0.5, 0.25), 1e-14)) << y.transpose();
}

// Well conditioned square ones are solved by elimination, others by pivots: both sides of the bound solve
// alike.
TEST(TaskJacobian, SquareOnesAreSolvedWhateverTheirCondition) {
  for (const double small : {1.0, 1e-3, 1e-5, 1e-7}) {
    TaskJacobian J(3, 3);
    J << 2, 1, 0,  //
        0, 1, 1,   //
        2, 2, 1 + small;
    // Third row less the first two: small * y3.
    AxisColumn y;
    ASSERT_TRUE(solve_minimum_norm(J, Eigen::Vector3d(5, 5, 10 + 3 * small), y)) << small;
    EXPECT_TRUE(y.isApprox(Eigen::Vector3d(1.5, 2, 3), 1e-15 / small * 30)) << small << ": " << y.transpose();
  }
  TaskJacobian J(2, 2);
  J << 1, 1, 1, 1;
  AxisColumn y;
  EXPECT_FALSE(solve_minimum_norm(J, Eigen::Vector2d(1, 1), y));
  EXPECT_TRUE(y.isApprox(Eigen::Vector2d(0.5, 0.5), 1e-14)) << y.transpose();
}

TEST(TaskJacobian, ALostDirectionIsLeftOutAndSaid) {
  AxisColumn y;
  EXPECT_FALSE(solve_minimum_norm(four_axes(1e-10), Eigen::Vector3d(1, 1, 1), y));
  EXPECT_TRUE(y.isApprox(Eigen::Vector4d(0.5, 0.5, 0.5, 0), 1e-9)) << y.transpose();
}

TEST(TaskJacobian, RowsAreSolvedColumnByColumn) {
  TaskRows wanted = TaskRows::Zero(3, 6);
  wanted.col(0) << 1, 1, 1;
  wanted.col(5) << 0, -2, 0;
  AxisRows y;
  ASSERT_TRUE(solve_minimum_norm(four_axes(4), wanted, y));
  EXPECT_TRUE(y.col(0).isApprox(Eigen::Vector4d(0.5, 0.5, 0.5, 0.25), 1e-14));
  EXPECT_TRUE(y.col(5).isApprox(Eigen::Vector4d(0, 0, -1, 0), 1e-14));
  EXPECT_LE(y.middleCols(1, 4).norm(), 1e-14);
}

TEST(TaskJacobian, ConditionNumberIsTheRatioOfSingularValuesUpToItsBound) {
  // Singular values of four_axes: sqrt(2), 2 and `last`.
  EXPECT_NEAR(condition_number(four_axes(4), 1e7), 4 / std::sqrt(2.0), 1e-14);
  EXPECT_EQ(condition_number(four_axes(1e-10), 1e7), 1e7);
  const TaskJacobian fewer = TaskJacobian::Identity(3, 2);
  EXPECT_EQ(condition_number(fewer, 1e7), 1e7);
}

// The pseudo-inverse by singular values says what is right, of every rank and shape.
TEST(TaskJacobian, ItIsThePseudoInverseWhateverTheRank) {
  Random random(7, "task Jacobian");
  for (const auto& [rows, columns] : {std::pair{3, 5}, {5, 5}, {6, 8}, {6, 4}})
    for (int rank = 1; rank <= std::min(rows, columns); ++rank) {
      const auto draw = [&](int m, int n) {
        Eigen::MatrixXd A(m, n);
        for (double& a : A.reshaped()) a = random.normal();
        return A;
      };
      const Eigen::MatrixXd A = draw(rows, rank) * draw(rank, columns), b = draw(rows, 1);
      Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
      svd.setThreshold(1e-9);
      const Eigen::VectorXd expected = svd.solve(b);
      AxisColumn y;
      EXPECT_EQ(solve_minimum_norm(TaskJacobian(A), TaskColumn(b), y), rank == rows);
      EXPECT_LE((y - expected).norm(), 1e-10 * (1 + expected.norm()))
          << rows << " x " << columns << ", " << rank;
    }
}

TEST(TaskJacobian, NothingAllocates) {
  const TaskJacobian J = four_axes(1e-10);
  const TaskColumn wanted = Eigen::Vector3d(1, 1, 1);
  AxisColumn y;
  const long before = allocations();
  const bool full_rank = solve_minimum_norm(J, wanted, y);
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_FALSE(full_rank);
}

}  // namespace
}  // namespace understudy::kinematics
