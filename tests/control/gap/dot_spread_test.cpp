// How wide the dot is, and that a part of one is not taken for all of it.
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "control/gap/gap_reading.h"
#include "control/gap/gap_sensor.h"
#include "core/units.h"
#include "tests/control/gap/gap_stage.h"

namespace understudy::control {
namespace {

TEST(DotSpread, IsThatOfRaysBesideTheBeam) {
  for (const double degrees : {-20.0, 0.0, 10.0, 20.0, 30.0})
    for (const double gap : {0.05e-3, 0.13e-3, 1e-3, 3e-3})
      for (const bool bottle : {false, true}) {
        const Start start = bottle ? on_bottle(degrees) : on_slope(degrees);
        Pose X_WT = start.X_WT_S;
        X_WT.translation() += (gap - kProgrammedGap) * tool_axis(X_WT);
        const Eigen::Matrix2d exact = *exact_spread(hexapod(), start.world, X_WT);
        Eigen::Matrix2d spread;
        ASSERT_TRUE(predict_spread(hexapod(), start.surface, gap, spread));
        // A pixel's own square adds 1/12; rays to one side against both sides differ by the beam's widening.
        EXPECT_LT((spread - exact - Eigen::Matrix2d::Identity() / 12).norm(), 0.01 * exact.norm())
            << degrees << " degrees, gap " << gap << (bottle ? ", bottle" : ", plane");
      }
}

TEST(DotSpread, OfAFlatIsTheWaistSeenAtItsAngles) {
  // Waist 0.15 mm, sigma 37.5 um, 64 px/mm: 2.4 px across the beam's plane; along it sigma / cos 40 degrees
  // on the flat, which the camera at 45 degrees foreshortens by cos 45 across the other azimuth; blur 0.7 px.
  Eigen::Matrix2d spread;
  ASSERT_TRUE(predict_spread(hexapod(), {}, 0, spread));
  const double s = 2.4, blur = 0.7 * 0.7 + 1.0 / 12;
  const double down = std::pow(s * std::cos(from_deg(45)), 2) + blur;
  const double across = std::pow(s / std::cos(from_deg(40)), 2) + blur;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  EXPECT_NEAR(solver.eigenvalues()[0], down, 0.02 * down);
  EXPECT_NEAR(solver.eigenvalues()[1], across, 0.02 * across);
}

/// The share of a Gaussian's second moment that is left, across the edge, beyond which a picture is hidden at
/// `d` standard deviations from its centre: 1 - d l - l^2, l = phi(d) / Phi(d).
double left_of_spread(double d) {
  const double l = std::exp(-d * d / 2) / std::sqrt(2 * M_PI) / (0.5 * std::erfc(-d / std::sqrt(2.0)));
  return 1 - d * l - l * l;
}

TEST(DotSpread, ThatIsLeftByAnEdgeIsThatOfACutGaussian) {
  const Start start = on_slope(10);
  const Vec2 dot = *exact_dot(hexapod(), start.world, start.X_WT_S);
  const Eigen::Matrix2d spread = *exact_spread(hexapod(), start.world, start.X_WT_S);
  GapRig rig(hexapod(), {start.world, Vec3::Zero(), Vec3::Zero(), 0, 1});
  RigMotion motion(hexapod(), rig);
  ASSERT_EQ(motion.move_to(start.X_WT_S), machine::Status::ok);
  for (const double d : {0.0, 0.5, 1.0, 3.5}) {
    const Vec2 side(1, 0);
    rig.set_frame_fault([&](const Pose&, Image& image) {
      hide_beyond(dot + d * std::sqrt(spread(0, 0)) * side, side, image);
      return true;
    });
    machine::Frame frame;
    const Region region = region_for_gap(hexapod(), start.surface, kProgrammedGap, 0.15e-3, 0.15e-3, 30);
    ASSERT_EQ(rig.port().capture(region, frame, rig.port().now() + 1), machine::Status::ok);
    const auto measured = vision::measure_dot(frame.image, dot_options(hexapod()));
    GapReading reading;
    ASSERT_TRUE(read_gap(hexapod(), start.surface, measured, reading));
    // A cut Gaussian is none: the window that fits it to one leaves the moments within a tenth. Pixels round.
    EXPECT_NEAR(reading.narrowest, left_of_spread(d), 0.1) << d;
    EXPECT_EQ(whole(reading, measured), d > 2) << d;
  }
}

/// How many of 40 frames over a flat are taken for whole; from `hidden_from` standard deviations of the dot's
/// centre on something hides it.
int whole_frames(const machine::MachineDescription& built, const machine::MachineDescription& believed,
                 double hidden_from) {
  const Start start = on_slope(0);
  const Vec2 dot = *exact_dot(built, start.world, start.X_WT_S);
  const Eigen::Matrix2d spread = *exact_spread(built, start.world, start.X_WT_S);
  GapRig rig(built, {start.world, Vec3::Zero(), Vec3::Zero(), 0, 1});
  RigMotion motion(built, rig);
  EXPECT_EQ(motion.move_to(start.X_WT_S), machine::Status::ok);
  const Vec2 side(1, 0);
  rig.set_frame_fault([&](const Pose&, Image& image) {
    hide_beyond(dot + hidden_from * std::sqrt(spread(0, 0)) * side, side, image);
    return true;
  });
  const Region region = region_for_gap(believed, start.surface, kProgrammedGap, 0.15e-3, 0.15e-3, 30);
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    machine::Frame frame;
    EXPECT_EQ(rig.port().capture(region, frame, rig.port().now() + 1), machine::Status::ok);
    const auto measured = vision::measure_dot(frame.image, dot_options(believed));
    GapReading reading;
    EXPECT_TRUE(read_gap(believed, start.surface, measured, reading));
    count += whole(reading, measured);
  }
  return count;
}

machine::MachineDescription with_waist(double share) {
  machine::MachineDescription machine = hexapod();
  machine.laser.waist_diameter *= share;
  return machine;
}

/// With a measured waist, known to 1 %.
machine::MachineDescription calibrated(double share) {
  machine::MachineDescription machine = with_waist(share);
  machine.gap_sensor = machine::GapSensorCalibration{};
  machine.gap_sensor->waist =
      machine::MeasuredWaist{hexapod().laser.waist_diameter, 0.01 * machine.laser.waist_diameter};
  return machine;
}

/// 0.75 is five of its tolerances of 5 %; the smooth dots of this rig are known better than those of speckle.
TEST(DotSpread, ANarrowBeamThatWasMeasuredIsWholeAndAHalfOfItIsNot) {
  for (const double share : {0.75, 1.25}) {
    const auto built = with_waist(share);
    EXPECT_EQ(whole_frames(built, calibrated(share), 9), 40) << share;
    EXPECT_EQ(whole_frames(built, calibrated(share), 0), 0) << share;
  }
  EXPECT_EQ(whole_frames(with_waist(0.75), hexapod(), 9), 0) << "the drawn beam is wider";
}

TEST(DotSpread, AWaistThatIsKnownBadlyIsNoReasonToCallADotHidden) {
  machine::MachineDescription believed = calibrated(1);
  EXPECT_EQ(whole_frames(with_waist(0.75), believed, 9), 0);
  believed.gap_sensor->waist->sigma = 0.1 * believed.laser.waist_diameter;
  EXPECT_EQ(whole_frames(with_waist(0.75), believed, 9), 40);
}

}  // namespace
}  // namespace understudy::control
