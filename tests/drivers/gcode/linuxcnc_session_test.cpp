// The conversation alone, with a scripted linuxcncrsh; LinuxCNC itself is in tests/drivers/linuxcnc.
#include "drivers/gcode/linuxcnc_session.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/drivers/gcode/scripted_rsh.h"

namespace understudy::drivers {
namespace {

using machine::AxisVector;
using machine::Fault;
using testing::HasSubstr;

const machine::MachineDescription& hexapod() { return ScriptedRsh::described(); }

class LinuxcncSessionTest : public testing::Test {
 protected:
  void connect() {
    session_.connect();
    run(1);
    AxisVector words = rsh_.pose;
    PathSample at;
    at.position = words;
    session_.begin(at);
  }
  void run(double seconds) {
    for (const double until = rsh_.now() + seconds; rsh_.now() < until;) {
      session_.pump();
      rsh_.wait(rsh_.now() + 0.01);
    }
  }
  Block block(double z_mm, double filament_mm, std::uint64_t executed) const {
    Block b;
    b.duration = 0.1;
    b.position = rsh_.pose;
    b.position[2] += from_mm(z_mm);
    b.filament = from_mm(filament_mm);
    b.executed = executed;
    return b;
  }

  ScriptedRsh rsh_;
  PoseWords words_{hexapod()};
  SessionOptions options_ = [] {
    SessionOptions options;
    options.step.fill(0.5e-6);
    return options;
  }();
  LinuxcncSession session_{rsh_, words_, options_, {}};
};

TEST_F(LinuxcncSessionTest, SendsTwoBlocksInALineAndCountsThemOnceItRestsWhereItShould) {
  connect();
  ASSERT_EQ(session_.fault(), Fault::none) << session_.fault_text();
  ASSERT_TRUE(session_.settled());
  rsh_.lines.clear();
  session_.push(block(1, 0.5, 3));
  session_.push(block(2, 1, 7));
  session_.push(block(2, 1.5, 9));  // filament alone
  AxisVector elsewhere = session_.position();
  elsewhere[0] += 1e-3;
  session_.push_rest(elsewhere);
  const AxisVector there = words_.joints_of_axes(elsewhere);
  run(0.02);
  EXPECT_EQ(session_.executed(), 0U);
  rsh_.joints = there;
  run(0.3);
  EXPECT_TRUE(session_.settled());
  EXPECT_EQ(session_.executed(), 9U);
  EXPECT_EQ(session_.fault(), Fault::none) << session_.fault_text();
  EXPECT_TRUE(
      rsh_.count("set mdi o<understudy_moves> call[0.0000][0.0000][-205.0000][0.00000][0.00000][0.00000][600]"
                 "[0.50000][5][0.0000][0.0000][-204.0000][0.00000][0.00000][0.00000][600][1.00000][5]"))
      << testing::PrintToString(rsh_.lines);
  EXPECT_TRUE(rsh_.count("set mdi o<understudy_feed> call[1.50000][5][0.1000]"));
}

TEST_F(LinuxcncSessionTest, TellsTheFirstErrorOfSeveralAndSendsNothingMore) {
  connect();
  rsh_.errors = {"Linear move on line 0 would exceed joint 0's positive limit", "another"};
  run(0.2);
  EXPECT_EQ(session_.fault(), Fault::drive);
  EXPECT_THAT(session_.fault_text(), HasSubstr("joint 0's positive limit"));
  const std::size_t lines = rsh_.lines.size();
  session_.push(block(1, 0, 1));
  run(0.2);
  EXPECT_EQ(rsh_.lines.size(), lines);
}

TEST_F(LinuxcncSessionTest, TellsWhyALineIsRefused) {
  connect();
  rsh_.refuses = "understudy_move";
  rsh_.errors = {"Unable to open file understudy_move.ngc"};
  session_.push(block(1, 0, 1));
  run(0.2);
  EXPECT_THAT(session_.fault_text(), HasSubstr("Unable to open file"));
}

TEST_F(LinuxcncSessionTest, NamesTheLineThatIsRefusedWithoutAnError) {
  connect();
  rsh_.refuses = "understudy_feed";
  Block feed = block(0, 0.5, 1);
  session_.push(feed);
  run(0.2);
  EXPECT_EQ(session_.fault(), Fault::drive);
  EXPECT_THAT(session_.fault_text(),
              HasSubstr("refuses 'set mdi o<understudy_feed> call[0.50000][5][0.1000]' and tells no error"));
}

TEST_F(LinuxcncSessionTest, LatchesStopsSilenceAndJointsThatStandElsewhere) {
  connect();
  rsh_.estop = "ON";
  run(0.2);
  EXPECT_EQ(session_.fault(), Fault::emergency_stop);

  rsh_.estop = "OFF";
  LinuxcncSession second(rsh_, words_, options_, {});
  second.connect();
  AxisVector elsewhere = second.position();
  elsewhere[4] += 2e-6;
  second.push_rest(elsewhere);
  for (int i = 0; i < 200; ++i, rsh_.wait(rsh_.now() + 0.01)) second.pump();
  EXPECT_EQ(second.fault(), Fault::following_error);
  EXPECT_THAT(second.fault_text(), HasSubstr("strut 5 rests at"));

  LinuxcncSession third(rsh_, words_, options_, {});
  third.connect();
  rsh_.silent = true;
  for (int i = 0; i < 600; ++i, rsh_.wait(rsh_.now() + 0.01)) third.pump();
  EXPECT_EQ(third.fault(), Fault::power);
}

TEST_F(LinuxcncSessionTest, RefusesAnotherKinematicsAndAMachineThatIsNotHomed) {
  rsh_.pose[2] += 1e-5;
  try {
    session_.connect();
    ADD_FAILURE() << "not refused";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("kinematics of another machine"));
  }
  rsh_.pose[2] -= 1e-5;
  rsh_.homed = "YES NO YES YES YES YES";
  LinuxcncSession second(rsh_, words_, options_, {});
  EXPECT_THROW(second.connect(), MachineError);
}

}  // namespace
}  // namespace understudy::drivers
