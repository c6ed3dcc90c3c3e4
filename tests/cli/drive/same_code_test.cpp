// The print loop of the machine gives the setpoints that the twin got, to the last bit, gap control included:
// it sees the frames that the twin took, and everything else comes from a loopback port.
#include <deque>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "control/program/gcode_options.h"
#include "core/file/read_file.h"
#include "geometry/mesh.h"
#include "machine/fixture_file.h"
#include "machine/loopback_port.h"
#include "machine/record/record_reader.h"
#include "machine/record/recording_port.h"
#include "tests/cli/drive/same_bits.h"
#include "tests/cli/program_run.h"
#include "toolpath/gcode/rewrite/turned_program.h"
#include "vision/plain_instructions.h"

namespace understudy::cli_test {
namespace {

using machine::Status;

constexpr double kTwinClock = 2e-3;  // [s], of the quasistatic twin

/// What the twin's port took and showed.
struct TwinRun {
  std::vector<machine::Setpoint> setpoints;
  std::deque<machine::RecordedFrame> frames;
};

TwinRun read_run(const std::string& record) {
  TwinRun run;
  machine::read_record(record, [&](const machine::RecordedEntry& entry) {
    const auto* submit = std::get_if<machine::RecordedSubmit>(&entry);
    if (submit && submit->answer == Status::ok)
      run.setpoints.insert(run.setpoints.end(), submit->setpoints.begin(), submit->setpoints.end());
    if (const auto* frame = std::get_if<machine::RecordedFrame>(&entry)) run.frames.push_back(*frame);
  });
  return run;
}

/// Axes are where they are told to be. A frame is the twin's, as long as it is asked for at the same time:
/// the setpoints up to then were the same, and so the machine is where the twin was.
class LoopbackThatSees : public machine::MachinePort {
 public:
  LoopbackThatSees(const machine::MachineDescription& machine, std::deque<machine::RecordedFrame> frames)
      : loopback_(options(machine)), camera_(machine.microscope), frames_(std::move(frames)) {}

  int axis_count() const override { return loopback_.axis_count(); }
  double now() const override { return loopback_.now(); }
  machine::AxisState state() const override {
    machine::AxisState state = loopback_.state();
    state.free_slots -= static_cast<std::size_t>(state.executed - executed_);
    state.executed = executed_;
    return state;
  }
  Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override {
    return loopback_.submit(setpoints, deadline);
  }
  /// The twin counts what it has executed at the beginning of a step of its clock: one step later than a
  /// machine that does it at once.
  Status wait_until(double time) override {
    const double before = now();
    if (time - kTwinClock > before)
      if (const Status s = loopback_.wait_until(time - kTwinClock); s != Status::ok) return s;
    const std::uint64_t executed = loopback_.state().executed;
    const double last = now();
    const Status answer = loopback_.wait_until(time);
    if (now() > last) executed_ = executed;
    return answer;
  }
  Status urgent(machine::UrgentCommand command) override { return loopback_.urgent(command); }
  Status set_outputs(const machine::Outputs& outputs, double deadline) override {
    return loopback_.set_outputs(outputs, deadline);
  }
  Status capture(const Region& region, machine::Frame& frame, double deadline) override {
    if (frames_.empty()) return Status::no_frame;
    const machine::RecordedFrame recorded = std::move(frames_.front());
    frames_.pop_front();
    if (recorded.now != now() || !(recorded.asked == region) || recorded.deadline != deadline) ++strange_;
    if (recorded.answer != Status::ok) return recorded.answer;
    const double start = now();
    if (const Status s = wait_until(start + 0.5 * camera_.exposure); s != Status::ok) return s;
    if (const Status s = wait_until(start + camera_.exposure + camera_.transfer); s != Status::ok) return s;
    if (now() != recorded.frame.received_at) ++strange_;
    frame = recorded.frame;
    return Status::ok;
  }

  int strange() const { return strange_; }  ///< frames that were asked for otherwise than on the twin
  std::size_t left() const { return frames_.size(); }

 private:
  static machine::LoopbackPort::Options options(const machine::MachineDescription& machine) {
    const auto mechanism = machine.make_mechanism();
    machine::LoopbackPort::Options options;
    options.clock_step = kTwinClock;
    options.axis_count = mechanism->axis_count();
    options.drive_zero = machine.drive_zero();
    const auto axes = std::span(options.start).first(static_cast<std::size_t>(options.axis_count));
    EXPECT_EQ(mechanism->inverse(machine.X_BT_home, {}, axes), kinematics::SolveStatus::ok);
    return options;
  }

  machine::LoopbackPort loopback_;
  decltype(machine::MachineDescription::microscope) camera_;
  std::deque<machine::RecordedFrame> frames_;
  std::uint64_t executed_ = 0;
  int strange_ = 0;
};

class SameCode : public testing::TestWithParam<control::GapControl> {};

TEST_P(SameCode, GivesTheMachineTheTwinsSetpointsWithGapControl) {
  const Folder folder;
  const std::string word = GetParam() == control::GapControl::start ? "start" : "continuous";
  const std::string file = kSource + "/scenarios/song-bottle.gcode";
  const Outcome rehearsed = understudy("rehearse " + file + " --fixture bottle --gap-control " + word +
                                       " --seed 6 --engine quasistatic --no-pictures --record " +
                                       (folder / "twin.record") + " --out " + (folder / "out"));
  ASSERT_LE(rehearsed.status, 1) << rehearsed.err;
  const TwinRun twin = read_run(folder / "twin.record");
  ASSERT_GT(twin.setpoints.size(), 5000U);
  ASSERT_GT(twin.frames.size(), GetParam() == control::GapControl::start ? 2U : 20U);

  const machine::MachineDescription machine = machine::load_machine("hexapod");
  const toolpath::Program program =
      toolpath::parse_turned_gcode(read_file(file), file, control::gcode_options({}, machine), {});
  const auto part = geometry::read_stl(machine::find_fixture("bottle"));
  vision::hold_opencv_to_plain_instructions();  // as the command does
  control::PrintOptions options;
  options.gap_control = GetParam();
  options.part = part.get();
  LoopbackThatSees port(machine, twin.frames);
  {
    machine::RecordWriter writer(folder / "machine.record", port.axis_count());
    machine::RecordingPort recorded(port, writer);
    control::print(program, machine, recorded, options);
    writer.flush();
  }
  EXPECT_EQ(port.strange(), 0);
  EXPECT_EQ(port.left(), 0U);
  const TwinRun driven = read_run(folder / "machine.record");
  ASSERT_EQ(driven.setpoints.size(), twin.setpoints.size());
  for (std::size_t i = 0; i < twin.setpoints.size(); ++i)
    ASSERT_TRUE(same_bits(twin.setpoints[i], driven.setpoints[i]))
        << i << " at " << twin.setpoints[i].time << " s, line " << twin.setpoints[i].line;
}

INSTANTIATE_TEST_SUITE_P(GapControl, SameCode,
                         testing::Values(control::GapControl::start, control::GapControl::continuous),
                         [](const auto& chosen) {
                           return chosen.param == control::GapControl::start ? "Start" : "Continuous";
                         });

}  // namespace
}  // namespace understudy::cli_test
