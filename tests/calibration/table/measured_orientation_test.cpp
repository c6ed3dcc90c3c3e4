#include "calibration/table/measured_orientation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::calibration {
namespace {

// The same rotation in every form: by 90 deg about x and then 90 deg about the fixed z; x goes to y, y to z.
Mat3 expected() {
  Mat3 R;
  R << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return R;
}

TEST(MeasuredOrientation, ReadsOneRotationInEveryForm) {
  const auto same = [](const OrientationReading& reading, const std::vector<double>& numbers) {
    return (orientation_of(reading, numbers) - expected()).norm() < 1e-12;
  };
  EXPECT_TRUE(same({OrientationForm::quaternion, "wxyz"}, {0.5, 0.5, 0.5, 0.5}));
  EXPECT_TRUE(same({OrientationForm::euler, "xyz", true, kDegree}, {90, 0, 90}));
  EXPECT_TRUE(same({OrientationForm::euler, "zyx", false, kDegree}, {90, 0, 90}));
  EXPECT_FALSE(same({OrientationForm::euler, "xyz", false, kDegree}, {90, 0, 90}));
  EXPECT_TRUE(same({OrientationForm::euler, "zyx", false, 1}, {90 * kDegree, 0, 90 * kDegree}));
  EXPECT_TRUE(same({OrientationForm::matrix}, {0, 0, 1, 1, 0, 0, 0, 1, 0}));
  const double third = 120 / std::sqrt(3.0);  // about (1, 1, 1)
  EXPECT_TRUE(same({OrientationForm::rotation_vector, "", false, kDegree}, {third, third, third}));
  const Mat3 R = orientation_of({OrientationForm::quaternion, "xyzw"}, {1, 0, 0, 0});
  EXPECT_EQ(R(1, 1), -1) << "half a turn about x";
}

TEST(MeasuredOrientation, SeesWhatIsNoRotation) {
  EXPECT_NEAR(off_rotation({OrientationForm::quaternion}, {0.5, 0.5, 0.5, 0.4}), 0.046, 0.001);
  EXPECT_EQ(off_rotation({OrientationForm::matrix}, {1, 0, 0, 0, 1, 0, 0, 0, -1}), 2) << "a mirror";
  EXPECT_NEAR(off_rotation({OrientationForm::matrix}, {1.1, 0, 0, 0, 1, 0, 0, 0, 1}), 0.21, 1e-12);
}

}  // namespace
}  // namespace understudy::calibration
