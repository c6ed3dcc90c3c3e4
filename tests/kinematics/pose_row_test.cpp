#include "kinematics/pose_row.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/random_vector.h"

namespace understudy::kinematics {
namespace {

TEST(PoseRow, APoseIsReadBackFromItsRow) {
  Random random(2, "pose row");
  for (int n = 0; n < 500; ++n) {
    const Pose X = make_pose(exp_rotation(uniform_vec3(random, 3)), uniform_vec3(random, 1));
    double row[kPoseNumbers];
    write_pose(X, row);
    EXPECT_GE(row[3], 0);
    Pose back;
    ASSERT_TRUE(read_pose(row, back));
    EXPECT_LT((back.matrix() - X.matrix()).cwiseAbs().maxCoeff(), 1e-14);  // some roundings of numbers near 1
    // Eigen's own conversion of the quaternion is the reference.
    const Mat3 expected = Quat(row[3], row[4], row[5], row[6]).toRotationMatrix();
    EXPECT_LT((back.linear() - expected).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(PoseRow, AQuaternionOfAnotherLengthIsNone) {
  Pose X;
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const double w : {0.0, 0.9998, 1.0002, none})
    EXPECT_FALSE(read_pose(std::array<double, 7>{1, 2, 3, w, 0, 0, 0}.data(), X)) << w;
  for (const double w : {0.99991, 1.00009, -1.0})
    EXPECT_TRUE(read_pose(std::array<double, 7>{1, 2, 3, w, 0, 0, 0}.data(), X)) << w;
}

}  // namespace
}  // namespace understudy::kinematics
