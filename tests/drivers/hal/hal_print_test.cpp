// The print loop of the rehearsal on LinuxCNC's HAL.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "control/print.h"
#include "tests/drivers/hal/hal_machine.h"
#include "tests/drivers/hal/received_setpoints.h"

namespace understudy::drivers {
namespace {

using machine::AxisState;
using machine::Fault;

constexpr int kMoves = 360;

/// A helix of beads about the middle of the work space, the tool tilted by 2 degrees towards where it goes;
/// the fan changes every 40 moves, for which the machine comes to rest.
toolpath::Program helix(const machine::MachineDescription& machine) {
  toolpath::Program program;
  program.file = "helix.gcode";
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  for (int i = 0; i <= kMoves; ++i) {
    const double turn = 0.02 * i;
    toolpath::Step step;
    step.kind = i == 0 ? toolpath::StepKind::travel : toolpath::StepKind::print;
    step.X_WT = X_WT_home;
    step.X_WT.translation() += Vec3(10e-3 * std::cos(turn), 10e-3 * std::sin(turn), -10e-6 * i);
    step.X_WT.linear() = exp_rotation(0.035 * Vec3(-std::sin(turn), std::cos(turn), 0)) * X_WT_home.linear();
    step.feed = 15e-3;
    step.filament = i == 0 ? 0 : 20e-6;
    step.line = i + 1;
    program.steps.push_back(step);
    if (i % 40 != 0) continue;
    toolpath::Step fan;
    fan.kind = toolpath::StepKind::fan;
    fan.fan = i / 40 % 2 == 0 ? 0.5 : 1;
    fan.line = i + 1;
    program.steps.push_back(fan);
  }
  return program;
}

/// At every rest of a print: where the drives are against where the last setpoint is.
class RestWatch : public control::PrintObserver {
 public:
  explicit RestWatch(const HalPort& port) : port_(port) {}
  void progress(std::size_t, std::size_t, double) override {
    const AxisState s = port_.state();
    if (s.moving || s.executed < s.accepted || s.executed == executed_) return;
    executed_ = s.executed;
    ++rests;
    for (std::size_t i = 0; i < 6; ++i) positions.push_back(s.position[i]);
  }
  int rests = 0;
  std::vector<double> positions;

 private:
  const HalPort& port_;
  std::uint64_t executed_ = 0;
};

TEST(HalPrint, SetpointsArriveInHalAsSentAndDrivesComeWithinAStep) {
  SKIP_WITHOUT_HAL();
  const HalMachine hal;
  const auto port = hal.open();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  HalRecorder received(hal, 1);
  RememberingPort remembering(*port);
  RestWatch watch(*port);
  control::PrintOptions options;
  options.gap_control = control::GapControl::off;
  const control::PrintResult result =
      control::print(helix(hal.machine()), hal.machine(), remembering, options, &watch);
  ASSERT_TRUE(result.completed) << result.stop.why << port->fault_text();
  EXPECT_GE(result.moves, 300);

  const auto rows = remembering.rows(hal.settings().cycle);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(expect_received(received.samples(), rows, hal.settings()), rows.size());

  // Each rest against the row that the machine rests at: the nearest of all, as rests have no number.
  EXPECT_GE(watch.rests, 8);
  double worst = 0;
  for (std::size_t r = 0; r + 6 <= watch.positions.size(); r += 6) {
    double best = 1;
    for (const auto& row : rows) {
      double off = 0;
      for (std::size_t i = 0; i < 6; ++i)
        off = std::max(off, std::abs(watch.positions[r + i] - row[i]) / hal.step(static_cast<int>(i)));
      best = std::min(best, off);
    }
    worst = std::max(worst, best);
  }
  EXPECT_LE(worst, 1.0) << "steps between drive and setpoint at rest";
  EXPECT_EQ(port->counts().underruns, 0U);
  std::printf(
      "%d moves in %.1f s, %zu setpoint rows, %d rests, worst %.2f steps of %.2f um, %llu underruns\n",
      result.moves, result.duration, rows.size(), watch.rests, worst, hal.step() * 1e6,
      static_cast<unsigned long long>(port->counts().underruns));
}

}  // namespace
}  // namespace understudy::drivers
