// Both kinds of machine behind one face.
#include "calibration/rows/row_machine.h"

#include <gtest/gtest.h>

#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

class RowMachines : public ::testing::TestWithParam<const char*> {};

TEST_P(RowMachines, ParameterRowsAreTheDerivativesOfForward) {
  DrawnRows lab({}, 2, GetParam());
  const auto parameters = static_cast<Eigen::Index>(lab.nominal.parameters().size());
  constexpr double kStep = 1e-6;
  for (int n = 0; n < 5; ++n) {
    const auto axes = lab.drawn_axes();
    const Pose X = lab.nominal.forward(axes);
    const Eigen::MatrixXd J = lab.nominal.parameter_rows(axes, X);
    ASSERT_EQ(J.cols(), parameters);
    for (Eigen::Index k = 0; k < parameters; ++k) {
      const Eigen::VectorXd by = kStep * Eigen::VectorXd::Unit(parameters, k);
      const Pose to = lab.nominal.moved(by).forward(axes), from = lab.nominal.moved(-by).forward(axes);
      Twist d;
      d << to.translation() - from.translation(), log_rotation(to.linear() * from.linear().transpose());
      EXPECT_LT((d / (2 * kStep) - J.col(k)).norm(), 1e-6 * (1 + J.col(k).norm())) << k;
    }
  }
}

TEST_P(RowMachines, TheFreeParametersAreAllThatPosesTellBesideFrameAndTarget) {
  DrawnRows lab({}, 2, GetParam());
  const auto free = lab.nominal.free_parameters(true, true);
  const auto known = lab.nominal.free_parameters(false, false);
  // With frame and target as columns of their own, the same number of independent columns.
  Eigen::MatrixXd J(240, 12 + static_cast<Eigen::Index>(free.size()));
  Eigen::MatrixXd all(240, 12 + static_cast<Eigen::Index>(lab.nominal.parameters().size()));
  for (Eigen::Index j = 0; j < 40; ++j) {
    const auto axes = lab.drawn_axes();
    const Pose X = lab.nominal.forward(axes);
    Eigen::Matrix<double, 6, 12> around = Eigen::Matrix<double, 6, 12>::Zero();
    around.leftCols<6>().setIdentity();
    for (Eigen::Index k = 0; k < 3; ++k) around.block<3, 1>(0, 3 + k) = Vec3::Unit(k).cross(X.translation());
    around.block<3, 3>(0, 6) = around.block<3, 3>(3, 9) = X.linear();
    const Eigen::MatrixXd rows = lab.nominal.parameter_rows(axes, X);
    J.middleRows<6>(6 * j) << around, rows(Eigen::all, free);
    all.middleRows<6>(6 * j) << around, rows;
  }
  const auto rank = [](const Eigen::MatrixXd& M) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(M);
    qr.setThreshold(1e-9);
    return qr.rank();
  };
  EXPECT_EQ(rank(J), J.cols());
  EXPECT_EQ(rank(all), J.cols());
  EXPECT_GT(known.size(), free.size());
}

INSTANTIATE_TEST_SUITE_P(CalibrateRows, RowMachines, ::testing::Values("arm", "hexapod"),
                         [](const auto& test) { return std::string(test.param); });

TEST(RowMachine, LengthsThatNoPoseHasAreNotFinite) {
  const DrawnRows lab({}, 2, "hexapod");
  EXPECT_FALSE(lab.nominal.forward({0.05, 0.9, 0.05, 0.9, 0.05, 0.9}).matrix().allFinite());
}

}  // namespace
}  // namespace understudy::calibration
