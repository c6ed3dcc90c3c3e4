// The conversation alone, with a scripted linuxcncrsh; LinuxCNC itself is in tests/drivers/linuxcnc.
#include "drivers/gcode/linuxcnc_session.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::drivers {
namespace {

using machine::AxisVector;
using machine::Fault;
using testing::HasSubstr;

const machine::MachineDescription& hexapod() {
  static const machine::MachineDescription machine = machine::load_machine("hexapod");
  return machine;
}

/// Answers a line at once, as seen of linuxcncrsh 1.1 (\r\n behind what it tells, \n\r behind ACK); no time
/// passes but in wait().
class ScriptedRsh : public ByteLink {
 public:
  ScriptedRsh() {
    AxisVector home{};
    const auto mechanism = hexapod().make_mechanism();
    EXPECT_EQ(mechanism->inverse(hexapod().X_BT_home, {}, std::span(home).first(6)),
              kinematics::SolveStatus::ok);
    joints = PoseWords(hexapod()).joints_of_axes(home);
    pose = pose_words(hexapod().X_BT_home);
  }
  double now() const override { return now_; }
  void wait(double until) override { now_ = std::max(now_, until); }
  std::size_t send(std::string_view bytes) override {
    in_ += bytes;
    for (std::size_t end; (end = in_.find("\r\n")) != std::string::npos; in_.erase(0, end + 2)) {
      const std::string line = in_.substr(0, end);
      lines.push_back(line);
      if (!silent) out_ += answer(line);
    }
    return bytes.size();
  }
  std::size_t receive(std::span<char> bytes) override {
    const std::size_t given = std::min<std::size_t>({bytes.size(), out_.size(), 7});
    std::copy_n(out_.begin(), given, bytes.begin());
    out_.erase(0, given);
    return given;
  }

  bool count(const std::string& part) const {
    return std::ranges::any_of(lines,
                               [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }

  std::vector<std::string> lines;
  AxisVector joints{}, pose{};
  std::vector<std::string> errors;
  std::string estop = "OFF", machine = "ON", homed = "YES", refuses;
  bool silent = false;

 private:
  static std::string six(const AxisVector& v, bool pose_words) {
    std::string text;
    for (std::size_t i = 0; i < 6; ++i)
      text += fmt::format(" {:.6f}", pose_words && i > 2 ? to_deg(v[i]) : to_mm(v[i]));
    return text + "\r\n";
  }
  std::string answer(const std::string& line) {
    if (line.starts_with("hello")) return "HELLO ACK EMCNETSVR 1.1\r\n";
    if (!refuses.empty() && line.find(refuses) != std::string::npos) return "SET MDI NAK\n\r";
    if (line.starts_with("set "))
      return "SET MDI ACK\n\r" + std::string(line == "set verbose on" ? "SET VERBOSE ACK\n\r" : "") + "SET " +
             upper(line.substr(4, line.find(' ', 4) - 4)) + "\r\n";
    if (line == "get joint_pos") return "JOINT_POS" + six(joints, false);
    if (line == "get abs_act_pos") return "ABS_ACT_POS" + six(pose, true);
    if (line == "get rel_act_pos") return "REL_ACT_POS" + six(pose, true);
    if (line == "get estop") return "ESTOP " + estop + "\r\n";
    if (line == "get machine") return "MACHINE " + machine + "\r\n";
    if (line == "get joint_homed") return "JOINT_HOMED " + homed + "\r\n";
    if (line == "get error") {
      if (errors.empty()) return "ERROR OK\r\n";
      const std::string first = errors.front();
      errors.erase(errors.begin());
      return "ERROR " + first + "\r\n";
    }
    return "";  // as for verbs that it does not know
  }
  static std::string upper(std::string word) {
    std::ranges::transform(word, word.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return word;
  }
  double now_ = 0;
  std::string in_, out_;
};

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
