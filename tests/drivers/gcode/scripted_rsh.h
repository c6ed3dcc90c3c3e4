// linuxcncrsh as a link: a hexapod that stands at home, on a clock of its own.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "drivers/gcode/byte_link.h"
#include "drivers/pose_words.h"
#include "machine/description.h"

namespace understudy::drivers {

/// Answers a line at once, as seen of linuxcncrsh 1.1 (\r\n behind what it tells, \n\r behind ACK); no time
/// passes but in wait().
class ScriptedRsh : public ByteLink {
 public:
  static const machine::MachineDescription& described() {
    static const machine::MachineDescription machine = machine::load_machine("hexapod");
    return machine;
  }
  ScriptedRsh() {
    machine::AxisVector home{};
    const auto mechanism = described().make_mechanism();
    EXPECT_EQ(mechanism->inverse(described().X_BT_home, {}, std::span(home).first(6)),
              kinematics::SolveStatus::ok);
    joints = PoseWords(described()).joints_of_axes(home);
    pose = pose_words(described().X_BT_home);
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
  machine::AxisVector joints{}, pose{};
  std::vector<std::string> errors;
  std::string estop = "OFF", switched = "ON", homed = "YES", refuses;
  bool silent = false;

 protected:
  static std::string six(const machine::AxisVector& v, bool pose_words) {
    std::string text;
    for (std::size_t i = 0; i < 6; ++i)
      text += fmt::format(" {:.6f}", pose_words && i > 2 ? to_deg(v[i]) : to_mm(v[i]));
    return text + "\r\n";
  }
  virtual std::string answer(const std::string& line) {
    if (line.starts_with("hello")) return "HELLO ACK EMCNETSVR 1.1\r\n";
    if (!refuses.empty() && line.find(refuses) != std::string::npos) return "SET MDI NAK\n\r";
    if (line.starts_with("set "))
      return "SET MDI ACK\n\r" + std::string(line == "set verbose on" ? "SET VERBOSE ACK\n\r" : "") + "SET " +
             upper(line.substr(4, line.find(' ', 4) - 4)) + "\r\n";
    if (line == "get joint_pos") return "JOINT_POS" + six(joints, false);
    if (line == "get abs_act_pos") return "ABS_ACT_POS" + six(pose, true);
    if (line == "get rel_act_pos") return "REL_ACT_POS" + six(pose, true);
    if (line == "get estop") return "ESTOP " + estop + "\r\n";
    if (line == "get machine") return "MACHINE " + switched + "\r\n";
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

}  // namespace understudy::drivers
