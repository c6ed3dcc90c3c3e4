#include "drivers/hal/hal_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/complaint.h"

namespace understudy::drivers {
namespace {

using ::testing::HasSubstr;

TEST(HalSettings, TakesScaleRangeAndLimitsFromTheMachineFile) {
  const HalSettings s = hal_settings(machine::load_machine("hexapod"));
  ASSERT_EQ(s.axes.size(), 7U) << "six struts and the filament";
  EXPECT_EQ(s.machine_axes, 6U);
  const HalAxis& l1 = s.axes[0];
  EXPECT_EQ(l1.name, "l1");
  // 200 full steps in 16 microsteps over a lead of 1.5875 mm.
  EXPECT_NEAR(l1.scale, 3200 / 1.5875, 1e-9);
  EXPECT_NEAR(l1.lower, 170, 1e-9);
  EXPECT_NEAR(l1.upper, 240, 1e-9);
  // 60 mm/s and 2000 mm/s2, and a tenth for interpolation and gap control.
  EXPECT_NEAR(l1.velocity, 66, 1e-9);
  EXPECT_NEAR(l1.acceleration, 2200, 1e-9);
  EXPECT_GT(l1.jump, l1.acceleration);
  EXPECT_FALSE(l1.assumed);
  EXPECT_TRUE(s.axes[6].assumed) << "machine files say nothing of the filament's drive";
  EXPECT_DOUBLE_EQ(s.cycle, 1e-3);
}

TEST(HalSettings, StandsAtTheAxesOfHome) {
  const auto machine = machine::load_machine("hexapod");
  std::array<double, 6> home{};
  ASSERT_EQ(machine.make_mechanism()->inverse(machine.X_BT_home, {}, home), kinematics::SolveStatus::ok);
  const HalSettings s = hal_settings(machine);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(s.axes[i].home, home[i] * 1e3, 1e-9);
}

TEST(HalSettings, CountsTurningAxesInDegrees) {
  const HalSettings s = hal_settings(machine::load_machine("arm"));
  // A gear of 100 behind a motor of 8192 counts a turn: 3.6 degrees a turn.
  EXPECT_NEAR(s.axes[0].scale, 8192 / 3.6, 1e-9);
  EXPECT_TRUE(s.axes[0].angle);
  EXPECT_NEAR(s.axes[1].home, 20, 1e-6);
  EXPECT_NEAR(s.axes[1].units(from_deg(30)), 30, 1e-12);
  EXPECT_NEAR(s.axes[1].si(30), from_deg(30), 1e-12);
}

TEST(HalSettings, NamesAxesAsHalTakesThem) {
  const auto of = [](const std::string& z, const std::string& x = "x") {
    return hal_settings(machine::load_machine("corexy{axes.2.name: " + x +
                                              ", geometry.tool_carried_by: " + x + ", axes.3.name: " + z +
                                              ", geometry.work_carried_by: " + z + "}"));
  };
  EXPECT_EQ(of("the bed").axes[2].name, "the-bed");
  EXPECT_EQ(complaint([&] { of(std::string(21, 'a')); }), "accepted");
  EXPECT_THAT(complaint([&] { of(std::string(22, 'a')); }),
              HasSubstr("has a name of 22 characters; HAL takes 21"));
  EXPECT_THAT(complaint([&] { of("a b", "a-b"); }), HasSubstr("in HAL: rename one"));
  EXPECT_THAT(complaint([&] { of("filament"); }), HasSubstr("in HAL: rename one"));
}

// What stands in a line of its own is run by HAL, as the user.
TEST(HalSettings, TheMachinesNameBreaksNoLine) {
  auto machine = machine::load_machine("hexapod");
  machine.name = "x\nloadusr touch /tmp/x";
  EXPECT_EQ(hal_settings(machine).machine, "x\\nloadusr touch /tmp/x");
}

TEST(HalSettings, AssumesAndSaysSoWhereTheMachineFileHasNoDrive) {
  auto machine = machine::load_machine("hexapod");
  machine.drives[2].lead = 0;
  const HalSettings s = hal_settings(machine);
  EXPECT_TRUE(s.axes[2].assumed);
  EXPECT_GT(s.axes[2].scale, 0);
  EXPECT_FALSE(s.axes[1].assumed);
}

TEST(HalSettings, LeavesAMillWithoutFilament) {
  auto machine = machine::load_machine("hexapod");
  machine.tool.nozzle_diameter = 0;
  EXPECT_FALSE(hal_settings(machine).prints());
}

TEST(HalSettings, TheFingerprintTellsOtherAxesApart) {
  auto machine = machine::load_machine("hexapod");
  const std::string before = hal_settings(machine).fingerprint;
  EXPECT_EQ(hal_settings(machine).fingerprint, before);
  machine.drives[5].microsteps = 8;
  EXPECT_NE(hal_settings(machine).fingerprint, before);
}

TEST(HalSettings, TakesEncodersBehindThePlayWhereEveryAxisHasOne) {
  const auto of = [](const std::string& machine) { return hal_settings(machine::load_machine(machine)); };
  const HalSettings plain = of("hexapod"), with = of("hexapod{load_encoders.count_um: 0.5}");
  EXPECT_FALSE(plain.load_encoders);
  ASSERT_TRUE(with.load_encoders);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(with.axes[i].count, 0.5e-3, 1e-15) << "mm";
  EXPECT_EQ(with.axes[6].count, 0) << "none at the filament";
  EXPECT_NE(with.fingerprint, plain.fingerprint) << "a sample has other columns";
  EXPECT_FALSE(of("five-axis{load_encoders.count_um: 0.5}").load_encoders) << "none at its turns";
}

TEST(HalSettings, RefusesMoreEncodersBehindThePlayThanASampleHoldsColumns) {
  // 8 axes and the filament, 8 of the state, 8 encoders.
  try {
    hal_settings(machine::load_machine("arm-positioner{load_encoders.count_arcmin: 0.1}"));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("load_encoders: with one at each of 8 axes a sample of HAL has "
                                   "25 columns, at most 21 can be"));
  }
}

TEST(HalSettings, NamesAxesThatSoftwareCannotStepFastEnough) {
  const auto lines = too_fast_for_software(hal_settings(machine::load_machine("hexapod")));
  ASSERT_EQ(lines.size(), 6U);
  // 60 mm/s of 2015.7 steps/mm against one step in 50 us.
  EXPECT_THAT(lines[0], testing::HasSubstr("l1: 60 mm/s need 120945 steps/s, and software makes 20000"));
  EXPECT_THAT(lines[0], testing::HasSubstr("(9.92 mm/s)"));
}

TEST(HalSettings, RefusesTimesThatCannotBe) {
  const auto machine = machine::load_machine("hexapod");
  const auto refusal = [&](const HalOptions& options) {
    try {
      hal_settings(machine, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  HalOptions options;
  options.base_period_us = 2;
  EXPECT_EQ(refusal(options), "base period: 2 us is outside 5..1000 us");
  options = {};
  options.watchdog = 0.001;
  EXPECT_EQ(refusal(options), "watchdog: 1 ms is outside 2..10000 ms");
  options = {};
  options.following = 20;
  EXPECT_EQ(refusal(options), "following: 20000 ms is outside 2..10000 ms");
}

}  // namespace
}  // namespace understudy::drivers
