// The print loop of the rehearsal on LinuxCNC's own planner and hexapod kinematics.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "drivers/gcode/gcode_port.h"
#include "tests/drivers/helix.h"
#include "tests/drivers/linuxcnc/linuxcnc_machine.h"

namespace understudy::drivers {
namespace {

using machine::Fault;

constexpr int kMovesInAPiece = 20;

toolpath::Program helix(const machine::MachineDescription& machine, int moves) {
  return program_of({.moves = moves,
                     .moves_in_a_piece = kMovesInAPiece,
                     .radius = 15e-3,
                     .turn = 0.06,
                     .tilt = 0.1,
                     .spin = 0.03,
                     .feed = 10e-3,
                     .filament = 40e-6},
                    machine);
}

/// At every rest of a print: drives behind LinuxCNC's kinematics against our inverse kinematics of the pose.
class RestWatch : public control::PrintObserver {
 public:
  RestWatch(const GcodePort& port, const machine::MachineDescription& machine,
            const toolpath::Program& program)
      : port_(port), machine_(machine), program_(program), mechanism_(machine.make_mechanism()) {}

  void progress(std::size_t done, std::size_t, double) override {
    const machine::AxisState s = port_.state();
    if (s.moving || s.executed < s.accepted || s.executed == executed_ || done == 0) return;
    executed_ = s.executed;
    std::size_t last = done - 1;
    while (last > 0 && program_.steps[last].kind == toolpath::StepKind::fan) --last;
    std::array<double, 6> ours{};
    const Pose X_BT = machine_.X_WB.inverse() * program_.steps[last].X_WT;
    ASSERT_EQ(mechanism_->inverse(X_BT, {}, ours), kinematics::SolveStatus::ok);
    const std::vector<double> drives = RunningLinuxcnc::strut_lengths();
    for (std::size_t i = 0; i < 6; ++i) {
      worst_joint = std::max(worst_joint, std::abs(s.position[i] - ours[i]));
      worst_drive = std::max(worst_drive, std::abs(drives[i] - ours[i]));
    }
    ++rests;
  }
  int rests = 0;
  double worst_joint = 0, worst_drive = 0;  // [m]

 private:
  const GcodePort& port_;
  const machine::MachineDescription& machine_;
  const toolpath::Program& program_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  std::uint64_t executed_ = 0;
};

/// False: LinuxCNC says that the computer was too busy for it, which is no failure of the port.
bool print_helix_once(int moves) {
  const RunningLinuxcnc linuxcnc;
  const auto port = open_gcode(parse_port_uri(linuxcnc.uri("&home=yes&reply_s=20")), linuxcnc.machine());
  const toolpath::Program program = helix(linuxcnc.machine(), moves);
  RestWatch watch(*port, linuxcnc.machine(), program);
  control::PrintOptions options;
  options.gap_control = control::GapControl::off;
  const auto begin = std::chrono::steady_clock::now();
  const control::PrintResult result = control::print(program, linuxcnc.machine(), *port, options, &watch);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (port->fault_text().find("the computer is too busy") != std::string::npos) return false;
  EXPECT_TRUE(result.completed) << result.stop.why << port->fault_text();
  EXPECT_GE(result.moves, moves);
  EXPECT_GE(watch.rests, moves / kMovesInAPiece);
  EXPECT_LE(watch.worst_joint, 1e-6);
  EXPECT_LE(watch.worst_drive, 1e-6);
  const double fed = 1e-3 * std::atof(RunningLinuxcnc::hal({"gets", "filament-command"}).c_str());
  EXPECT_NEAR(fed, result.extruded, 1e-7);
  std::printf(
      "%d moves in %.1f s as planned, %.1f s here; %d rests: joints %.2f um, drives %.2f um from ours\n",
      result.moves, result.duration, taken.count(), watch.rests, 1e6 * watch.worst_joint,
      1e6 * watch.worst_drive);
  return true;
}

void print_helix(int moves) {
  const bool in_time = print_helix_once(moves) || print_helix_once(moves);
  EXPECT_TRUE(in_time) << "twice the computer was too busy for LinuxCNC";
}

TEST(SlowLinuxcncPrint, RestsWhereOurInverseKinematicsSays) {
  SKIP_WITHOUT_LINUXCNC();
  print_helix(40);
}

TEST(SlowLinuxcncPort, SwitchesTheHeaterOffByWordAndByAnEmergencyStop) {
  SKIP_WITHOUT_LINUXCNC();
  const RunningLinuxcnc linuxcnc;
  const auto port = open_gcode(parse_port_uri(linuxcnc.uri("&home=yes&reply_s=20")), linuxcnc.machine());
  const auto nozzle = [] { return std::atof(RunningLinuxcnc::hal({"gets", "nozzle-setpoint"}).c_str()); };
  const machine::Outputs hot{.nozzle_temperature = 273.15 + 210, .fan = 0.5};
  ASSERT_EQ(port->set_outputs(hot, port->now() + 1), machine::Status::ok);
  ASSERT_EQ(port->wait_until(port->now() + 0.1), machine::Status::ok) << port->fault_text();
  EXPECT_NEAR(nozzle(), 210, 1e-6);
  ASSERT_EQ(port->set_outputs({}, port->now() + 1), machine::Status::ok);
  EXPECT_EQ(nozzle(), 0);

  ASSERT_EQ(port->set_outputs(hot, port->now() + 1), machine::Status::ok);
  ASSERT_EQ(port->wait_until(port->now() + 0.1), machine::Status::ok) << port->fault_text();
  ASSERT_NEAR(nozzle(), 210, 1e-6);
  port->emergency_stop();
  EXPECT_EQ(port->state().fault, Fault::emergency_stop);
  EXPECT_THAT(RunningLinuxcnc::hal({"gets", "machine-on"}), testing::HasSubstr("FALSE"));
  EXPECT_EQ(nozzle(), 0);
}

TEST(SlowLinuxcncPrint, RestsWhereOurInverseKinematicsSaysInThreeHundredMoves) {
  SKIP_WITHOUT_LINUXCNC();
  print_helix(320);
}

}  // namespace
}  // namespace understudy::drivers
