// What is common to all measured poses, against frames that were moved by hand.
#include "calibration/machine/measuring_frame.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::calibration {
namespace {

constexpr std::size_t kDevices = 2000;

/// Tips in a cube of 80 mm, seen by devices whose frames are off by sigma; `own` [m] besides at each pose.
std::vector<SharedError> seen_by(const MeasuringFrame& sigma, double own) {
  Random random(3, "measuring frames");
  const auto normal = [&](double s) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vec3(s * x, s * y, s * z);
  };
  std::vector<SharedError> poses(12);
  for (SharedError& pose : poses)
    pose.tip =
        Vec3(random.uniform(-40e-3, 40e-3), random.uniform(-40e-3, 40e-3), random.uniform(80e-3, 160e-3));
  Vec3 middle = Vec3::Zero();
  for (const SharedError& pose : poses) middle += pose.tip / 12;
  for (std::size_t r = 0; r < kDevices; ++r) {
    const Vec3 shift = normal(sigma.position), turn = normal(sigma.rotation);
    Mat3 strain;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) strain(i, j) = strain(j, i) = sigma.strain * random.normal();
    for (SharedError& pose : poses) {
      Twist e;
      e << shift + turn.cross(pose.tip - middle) + strain * (pose.tip - middle) + normal(own), turn;
      pose.shifts.push_back(e);
    }
  }
  return poses;
}

TEST(MeasuringFrame, IsFoundAgainFromWhatItsMotionDoes) {
  const MeasuringFrame sigma{8e-6, 60e-6, 40e-6};
  auto poses = seen_by(sigma, 0);
  const MeasuringFrame found = measuring_frame(poses);
  // 6000 draws and more know a standard deviation to 0.9 %; four of them.
  EXPECT_NEAR(found.position, sigma.position, 0.036 * sigma.position);
  EXPECT_NEAR(found.rotation, sigma.rotation, 0.036 * sigma.rotation);
  EXPECT_NEAR(found.strain, sigma.strain, 0.036 * sigma.strain);
  for (const SharedError& pose : poses) EXPECT_LT(std::sqrt(pose.left.trace()), 1e-12);  // rounding
}

TEST(MeasuringFrame, LeavesToThePosesWhatNoFrameExplains) {
  constexpr double kOwn = 5e-6;
  auto poses = seen_by({8e-6, 60e-6, 0}, kOwn);
  measuring_frame(poses);
  double left = 0;
  for (const SharedError& pose : poses) left += pose.left.topLeftCorner<3, 3>().trace();
  // Of the 36 numbers of 12 positions frame and strain take up to 12: their share is left out.
  EXPECT_LT(std::sqrt(left / 36), kOwn);
  EXPECT_GT(std::sqrt(left / 36), std::sqrt(24.0 / 36) * 0.98 * kOwn);
}

TEST(MeasuringFrame, OnePoseTellsOfNoStrain) {
  auto poses = seen_by({8e-6, 60e-6, 40e-6}, 0);
  poses.resize(1);
  const MeasuringFrame found = measuring_frame(poses);
  EXPECT_EQ(found.strain, 0);
  EXPECT_TRUE(std::isfinite(found.position) && found.position > 0);
}

TEST(MeasuringFrame, MovesAPointByItsShiftItsTurnAndItsStrain) {
  const MeasuringFrame frame{3e-6, 100e-6, 50e-6};
  // 40 mm out along x: 4 um across by the turn, 2 um along by the scale and across by the shear.
  const Mat3 at = frame.covariance({40e-3, 0, 0});
  EXPECT_NEAR(at(0, 0), 9e-12 + 4e-12, 1e-20);
  EXPECT_NEAR(at(1, 1), 9e-12 + 16e-12 + 4e-12, 1e-20);
  EXPECT_NEAR(at(2, 2), at(1, 1), 1e-20);
  EXPECT_NEAR(at(0, 1), 0, 1e-20);
  // A shear of x by y is one of y by x: both go together.
  EXPECT_NEAR(MeasuringFrame({0, 0, 50e-6}).covariance({40e-3, 20e-3, 0})(0, 1), 2e-12, 1e-20);
}

}  // namespace
}  // namespace understudy::calibration
