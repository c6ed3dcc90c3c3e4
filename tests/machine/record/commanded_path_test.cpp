#include "machine/record/commanded_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "machine/loopback_port.h"
#include "machine/record/recording_port.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

constexpr double kNever = 1e9;

/// Its axes are behind their plays by a fixed distance.
class PortWithScales : public LoopbackPort, public LoadSide {
 public:
  using LoopbackPort::LoopbackPort;
  bool read_load(LoadReading& reading) const override {
    reading.sampled_at = now();
    reading.position = state().position;
    for (double& position : reading.position) position += 40e-6;
    return true;
  }
};

AxisVector home_of(const MachineDescription& machine) {
  AxisVector home{};
  EXPECT_EQ(machine.make_mechanism()->inverse(machine.X_BT_home, {}, std::span(home).first(6)),
            kinematics::SolveStatus::ok);
  return home;
}

/// Six axes that swing by 5 mm, each later than the one before.
std::vector<Setpoint> swings(const AxisVector& home) {
  std::vector<Setpoint> setpoints;
  for (int k = 1; k <= 300; ++k) {
    Setpoint s;
    s.time = 0.01 * k;
    s.line = k;
    for (std::size_t i = 0; i < 6; ++i) {
      const double rate = 1 + 0.1 * static_cast<double>(i), share = 0.5 * (1 - std::cos(2 * s.time));
      s.position[i] = home[i] + 5e-3 * rate * share;
      s.velocity[i] = 5e-3 * rate * std::sin(2 * s.time);
    }
    setpoints.push_back(s);
  }
  return setpoints;
}

class CommandedPathTest : public ::testing::Test {
 protected:
  CommandedPathTest() {
    LoopbackPort::Options options;
    options.start = home_of(machine_);
    options.clock_step = 0.5e-3;
    PortWithScales port(options);
    RecordWriter writer(file_, 6);
    RecordingPort recorded(port, writer);
    writer.note("machine_sha256 " + machine_.sha256);
    EXPECT_EQ(recorded.submit(swings(options.start), kNever), Status::ok);
    EXPECT_EQ(recorded.wait_until(0.7), Status::ok);
    EXPECT_EQ(recorded.urgent(UrgentCommand::hold), Status::ok);
    EXPECT_EQ(recorded.wait_until(1.1), Status::ok);
    EXPECT_EQ(recorded.urgent(UrgentCommand::resume), Status::ok);
    EXPECT_EQ(recorded.wait_until(2.0), Status::ok);
    EXPECT_EQ(recorded.urgent(UrgentCommand::stop), Status::ok);
    EXPECT_EQ(recorded.wait_until(2.5), Status::ok);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.record";
  const MachineDescription machine_ = load_machine("hexapod");
};

TEST_F(CommandedPathTest, IsWhereThePortItselfWasThroughHoldResumeAndStop) {
  const RecordedMotion motion = read_motion(file_);
  EXPECT_TRUE(motion.whole);
  EXPECT_EQ(motion.commands.size(), 4U);
  ASSERT_GT(motion.drives.size(), 240U);
  CommandedPath path(motion, machine_);
  double moved = 0;
  for (const LoadReading& reading : motion.drives) {
    const auto& target = path.at(reading.sampled_at);
    for (std::size_t i = 0; i < 6; ++i) {
      // A loopback port that is held states where it was a step before it came to rest, at 5 mm/s and below.
      ASSERT_NEAR(target.position[i], reading.position[i], 0.5e-3 * 5e-3)
          << reading.sampled_at << " axis " << i;
      moved = std::max(moved, std::abs(reading.position[i] - motion.drives.front().position[i]));
    }
  }
  EXPECT_GT(moved, 2e-3);
}

TEST_F(CommandedPathTest, TheRecordHoldsWhatIsMeasuredBehindThePlay) {
  const RecordedMotion motion = read_motion(file_);
  ASSERT_EQ(motion.load.size(), motion.drives.size());
  for (std::size_t k = 0; k < motion.load.size(); ++k) {
    EXPECT_EQ(motion.load[k].sampled_at, motion.drives[k].sampled_at);
    EXPECT_DOUBLE_EQ(motion.load[k].position[3], motion.drives[k].position[3] + 40e-6);
  }
}

TEST_F(CommandedPathTest, AnotherMachineIsRefused) {
  const RecordedMotion motion = read_motion(file_);
  EXPECT_NO_THROW(require_same_machine(motion, machine_));
  EXPECT_THROW(require_same_machine(motion, load_machine("hexapod{gap.aim_mm: 0.14}")), InputError);
  EXPECT_THROW(require_same_machine(motion, load_machine("five-axis")), InputError);
}

}  // namespace
}  // namespace understudy::machine
