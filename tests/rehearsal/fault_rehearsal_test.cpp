// Faults in a whole rehearsal: where the tip goes is a column of the inverse Jacobian; bad requests have a
// line.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using sim::FaultKind;
using testing::AllOf;
using testing::HasSubstr;

class FaultyRehearsal : public testing::Test {
 protected:
  FaultyRehearsal() {
    // From -3 to +3 mm in 6 s, 45 mm over the table; struts 1 and 2 move steadily.
    std::ofstream(folder_ / "line.gcode")
        << "G21\nG90\nM82 M109 S230\nG94\nG0 X-3 Y0 Z45\nG1 X3 Y0 Z45 E0.5 F60\n";
  }

  Record run(const std::vector<FaultRequest>& faults, const std::string& machine = "hexapod") const {
    RehearsalRequest request;
    request.program = (folder_ / "line.gcode").string();
    request.machine = machine;
    request.engine = "quasistatic";
    request.as_built = "nominal";
    request.gap_control = "off";
    request.keep_scene = false;
    request.compare_without_gap_control = false;
    request.faults = faults;
    return rehearse(request);
  }

  /// The tip's shift against a sound machine, from `from` on, is strut 1's change by the inverse Jacobian.
  template <typename Change>
  void expect_shift(const Record& sound, const Record& faulty, double from, const Change& change) const {
    ASSERT_EQ(sound.trace.size(), faulty.trace.size());
    int compared = 0;
    double largest = 0;
    for (std::size_t k = 0; k < sound.trace.size(); ++k) {
      const TracePoint &a = sound.trace[k], &b = faulty.trace[k];
      ASSERT_EQ(a.time, b.time);
      const Vec3 shift = b.X_WT.translation() - a.X_WT.translation();
      if (a.time < 2.0) {
        ASSERT_EQ(shift, Vec3(0, 0, 0)) << "before the fault, at " << a.time;
      }
      if (a.time < from) continue;
      Mat6 J;
      ASSERT_EQ(kinematics::jacobian(machine_.hexapod().geometry, machine_.X_WB.inverse() * a.X_WT, J),
                kinematics::SolveStatus::ok);
      const Eigen::Matrix<double, 6, 1> column = J.inverse().col(0);
      const Vec3 expected = machine_.X_WB.linear() * (column.head<3>() * change(a.time));
      // The next order, (64 um)^2 over the platform's 30 mm, is 0.14 um; a play of a strut shifts with it.
      ASSERT_LT((shift - expected).norm(), 0.5e-6) << "at " << a.time;
      largest = std::max(largest, expected.norm());
      ++compared;
    }
    EXPECT_GT(compared, 500);
    EXPECT_GT(largest, 20e-6);
  }

  static FaultRequest request(const sim::FaultEvent& event, const std::string& axis) {
    return {event, axis, false, Place{"s.yaml", 7, 0}};
  }

  const TemporaryFolder folder_;
  const machine::MachineDescription machine_ = machine::load_machine("hexapod");
};

TEST_F(FaultyRehearsal, LostStepsShiftTheTipByTheInverseJacobianFromThenOn) {
  const Record sound = run({});
  const Record faulty = run({request({FaultKind::lost_steps, 0, 2.0, 8}, "l1")});
  const double slip = 8 * machine_.drives[0].lead / machine_.drives[0].steps_per_turn;
  // The rotor lags behind: which way the strut runs is seen in the controller's own axes.
  const auto& axes = sound.trace;
  const std::size_t middle = axes.size() / 2;
  const double direction = axes[middle].axes[0] > axes[middle - 200].axes[0] ? 1 : -1;
  expect_shift(sound, faulty, 3.0, [&](double) { return -direction * slip; });
  EXPECT_THAT(faulty.provenance.faults, testing::ElementsAre("8 lost steps of axis l1 at 2.000 s"));
}

TEST_F(FaultyRehearsal, AStrutThatWarmsShiftsTheTipByTheInverseJacobian) {
  const Record sound = run({});
  const Record faulty = run({request({FaultKind::thermal_growth, 0, 2.0, 0, 3.0, 60e-6}, "l1")});
  // A plant's step of 2 ms is 40 nm of the ramp.
  expect_shift(sound, faulty, 2.1, [](double time) { return 60e-6 * std::min(1.0, (time - 2.0) / 3.0); });
}

TEST_F(FaultyRehearsal, TheControllersAxesAreThoseOfASoundMachine) {
  const Record sound = run({});
  const Record faulty = run({request({FaultKind::lost_steps, 0, 2.0, 8}, "l1")});
  const double step = machine_.drives[0].step();
  for (std::size_t k = 0; k < sound.trace.size(); ++k)
    for (std::size_t i = 0; i < 6; ++i)
      ASSERT_NEAR(sound.trace[k].axes[i], faulty.trace[k].axes[i], step) << sound.trace[k].time;
}

TEST_F(FaultyRehearsal, APowerCutIsANoGoWithItsReason) {
  FaultRequest cut;
  cut.event.kind = FaultKind::power_cut;
  cut.event.time = 3.0;
  // Screws of 1/16 inch a turn hold without current, told by the file or not.
  std::string yaml = read_file(machine_.file);
  if (!machine_.drives[0].self_locking)
    yaml.replace(yaml.find("  microsteps: 16\n"), 17, "  microsteps: 16\n  self_locking: yes\n");
  std::ofstream(folder_ / "machine.yaml") << yaml;
  const Record record = run({cut}, (folder_ / "machine.yaml").string());
  EXPECT_FALSE(record.go);
  ASSERT_FALSE(record.findings.empty());
  std::vector<std::string> messages;
  for (const Finding& f : record.findings) messages.push_back(f.message);
  EXPECT_THAT(messages, testing::Contains(HasSubstr("the machine reports a fault: power cut")));
}

TEST_F(FaultyRehearsal, RequestsThatTheMachineCannotServeAreRefusedAtTheirLine) {
  const auto refused = [&](const FaultRequest& fault) -> std::string {
    try {
      run({fault});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refused(request({FaultKind::stall, 0, 1, 0, 1}, "j1")),
              AllOf(HasSubstr("s.yaml:7"), HasSubstr("axis 'j1' is not one of hexapod's: l1, l2")));
  EXPECT_THAT(refused(request({FaultKind::lost_steps, 0, 1, 6}, "l1")),
              AllOf(HasSubstr("s.yaml:7"), HasSubstr("6 steps, not a positive multiple of 4")));
  FaultRequest turn = request({FaultKind::thermal_growth, 0, 1, 0, 1, 1e-4}, "l1");
  turn.angle = true;
  EXPECT_THAT(refused(turn),
              AllOf(HasSubstr("s.yaml:7"), HasSubstr("axis 'l1' slides: its amount is in um")));
}

}  // namespace
}  // namespace understudy::rehearsal
