#include "control/gap/sensor_uncertainty.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/gap/gap_reading.h"
#include "core/random.h"
#include "core/units.h"
#include "machine/optics_mounting.h"
#include "tests/control/gap/bead_program.h"
#include "tests/control/gap/gap_rig.h"

namespace understudy::control {
namespace {

using testing::HasSubstr;
using Mounting = machine::OpticsMounting;

/// A calibration that leaves laser and microscope together higher or lower by `sigma` [m], and nothing else.
machine::MachineDescription known_to(double sigma) {
  machine::MachineDescription m = hexapod();
  const Mounting drawn = machine::mounting_of(m);
  machine::MountingVector up = machine::MountingVector::Zero();
  up.head<2>() = drawn.X_TL.linear().row(2).head<2>().transpose();
  up.segment<3>(4) = drawn.X_TC.linear().row(2).transpose();
  m.gap_sensor = {drawn, "", "", 1, sigma * sigma * up * up.transpose(), {}};
  return m;
}

LocalSurface sloping(double x, double y) {
  LocalSurface surface;
  surface.slope = Vec2(x, y);
  return surface;
}

TEST(SensorUncertainty, ASensorThatStandsHigherReadsAsMuchMore) {
  for (const double gap : {0.1e-3, 0.13e-3, 1e-3})
    EXPECT_NEAR(calibration_sigma(known_to(7e-6), {}, gap), 7e-6, 1e-10);  // the track is straight to 1e-5
  EXPECT_NEAR(calibration_sigma(known_to(7e-6), sloping(0.3, -0.2), 0.13e-3), 7e-6, 1e-10);
}

TEST(SensorUncertainty, IsNoneWithoutACalibrationAndWithoutBoundWithoutADot) {
  EXPECT_EQ(calibration_sigma(hexapod(), {}, 0.13e-3), 0);
  EXPECT_TRUE(std::isinf(calibration_sigma(known_to(7e-6), sloping(0, 5), 0.13e-3)));
}

/// What read_gap() makes of dots of sensors drawn from a full covariance, over surfaces of each kind.
TEST(SensorUncertainty, IsTheSpreadOfReadingsOfSensorsDrawnFromTheCovariance) {
  machine::MachineDescription m = hexapod();
  Random random(8, "drawn sensors");
  machine::MountingMatrix root;
  for (int i = 0; i < machine::kMountingFreedoms; ++i)
    for (int j = 0; j < machine::kMountingFreedoms; ++j) root(i, j) = 1e-5 * random.normal();
  const Mounting mounting = machine::mounting_of(m);
  m.gap_sensor = {mounting, "", "", 1, root * root.transpose(), {}};
  LocalSurface curved = sloping(0.2, -0.1);
  curved.curvature(0, 0) = -1 / 15.5e-3;
  for (const LocalSurface& surface : {LocalSurface{}, sloping(0.3, 0.3), curved}) {
    double squares = 0;
    constexpr int kDraws = 800;
    for (int k = 0; k < kDraws; ++k) {
      machine::MountingVector normal;
      for (int i = 0; i < machine::kMountingFreedoms; ++i) normal[i] = random.normal();
      machine::Laser laser = m.laser;
      machine::Microscope microscope = m.microscope;
      machine::set_mounting(machine::moved(mounting, root * normal), laser, microscope);
      vision::DotMeasurement dot;
      GapReading reading;
      ASSERT_TRUE(dot_pixel(laser, microscope, surface, 0.13e-3, dot.position_px));
      ASSERT_TRUE(read_gap(m, surface, dot, reading));
      squares += std::pow(reading.gap - 0.13e-3, 2) / kDraws;
    }
    const double sigma = calibration_sigma(m, surface, 0.13e-3);
    EXPECT_NEAR(std::sqrt(squares), sigma, 0.1 * sigma);  // 800 draws: 2.5 %, 4 sigma
  }
}

TEST(SafeAim, MovesIntoTheBandAsFarAsThreeSigmaNeed) {
  const double aim = 0.13e-3;
  EXPECT_EQ(safe_aim(hexapod(), {}, aim).gap, aim);
  EXPECT_EQ(safe_aim(hexapod(), {}, 0.101e-3).gap, 0.101e-3);  // unchanged where nothing is known
  EXPECT_EQ(safe_aim(known_to(5e-6), {}, aim).gap, aim);
  const SafeAim moved = safe_aim(known_to(12e-6), {}, aim);  // 3 hypot(12, 5) um inside
  EXPECT_TRUE(moved.fits);
  EXPECT_NEAR(moved.gap, 0.139e-3, 1e-8);
  EXPECT_NEAR(safe_aim(known_to(12e-6), {}, 0.19e-3).gap, 0.161e-3, 1e-8);
  EXPECT_TRUE(safe_aim(known_to(15.8e-6), {}, aim).fits);
  EXPECT_FALSE(
      safe_aim(known_to(16e-6), {}, aim).fits);  // 3 hypot(16, 5) um are 50.3: half of the band is 50
  EXPECT_FALSE(safe_aim(known_to(1e-6), sloping(0, 5), aim).fits);
}

PrintResult printed(const machine::MachineDescription& machine, GapControl control, GapRig& rig) {
  PrintOptions options;
  options.gap_control = control;
  return print(bead_program(), machine, rig.port(), options);
}

TEST(SafeAim, AnApproachEndsThere) {
  const auto machine = known_to(12e-6);
  double gap = 0;
  constexpr int kRuns = 8;
  for (int seed = 1; seed <= kRuns; ++seed) {
    GapRig rig(hexapod(),
               {flat_part(), Vec3(0, 0, 0.2e-3), Vec3::Zero(), 0.35, static_cast<std::uint64_t>(seed)});
    const PrintResult result = printed(machine, GapControl::start, rig);
    ASSERT_TRUE(result.completed) << result.stop.why;
    ASSERT_EQ(result.approaches.size(), 1u);
    EXPECT_NEAR(result.approaches[0].outcome.calibration_sigma, 12e-6, 1e-9);
    gap += result.approaches[0].outcome.gap / kRuns;
  }
  EXPECT_NEAR(gap, 0.139e-3, 8e-6);  // the tolerance of an approach
}

TEST(SafeAim, AlongThePathToo) {
  GapRig rig(hexapod(), low_by(0.1e-3));
  const PrintResult result = printed(known_to(12e-6), GapControl::continuous, rig);
  ASSERT_TRUE(result.completed) << result.stop.why;
  ASSERT_TRUE(result.following);
  EXPECT_NEAR(result.following->gap, 0.139e-3, 6e-6);
}

TEST(SafeAim, AnUncertainSensorStopsThePrintBeforeTheToolComesDown) {
  for (const GapControl control : {GapControl::start, GapControl::continuous}) {
    GapRig rig(hexapod(), low_by(0));
    const PrintResult result = printed(known_to(16e-6), control, rig);
    EXPECT_FALSE(result.completed);
    EXPECT_EQ(result.stop.gap, GapStop::uncertain);
    EXPECT_STREQ(to_string(result.stop.gap), "sensor too uncertain");
    EXPECT_THAT(
        result.stop.why,
        HasSubstr("the calibration of the gap sensor leaves 0.016 mm of the gap here (1 sigma): 3 sigma do "
                  "not fit into the accepted 0.100 to 0.200 mm; retreated"));
    EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0);
    double lowest = 1;
    for (const auto& s : rig.port().history())
      if (s.line >= 4)  // from S' on; home is on the part
        lowest = std::min(lowest, rig.gap_at(rig.commanded(s.position)));
    EXPECT_GT(lowest, 1.9e-3);
  }
}

/// Without an approach it is the first frame along the path that says so.
TEST(SafeAim, AnUncertainSensorStopsAPrintWithoutAnApproach) {
  toolpath::Program program = bead_program();
  program.steps.erase(program.steps.begin() + 3);
  program.steps[3] = step_to(toolpath::StepKind::travel, {0, 0, kTable + kGap}, 0, 5);
  GapRig rig(hexapod(), low_by(50e-6));
  PrintOptions options;
  options.gap_control = GapControl::continuous;
  const PrintResult result = print(program, known_to(16e-6), rig.port(), options);
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.gap, GapStop::uncertain);
  EXPECT_THAT(result.stop.why, HasSubstr("3 sigma do not fit"));
}

}  // namespace
}  // namespace understudy::control
