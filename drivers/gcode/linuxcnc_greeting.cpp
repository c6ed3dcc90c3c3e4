// How a session with linuxcncrsh begins: switched on, homed, in the modes of our blocks, and with the
// kinematics of the machine file.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "drivers/gcode/linuxcnc_session.h"

namespace understudy::drivers {

using machine::AxisVector;

namespace {

constexpr double kAgain = 0.1;      // [s], between two questions
constexpr double kHomeTime = 180;   // [s], for all joints
constexpr double kPlaceOff = 2e-6;  // [m], of what is printed with six decimals of a mm
constexpr double kTurnOff = 2e-7;   // [rad], likewise
constexpr int kErrorsMost = 100;    // that wait from before

AxisVector six_numbers(const std::string& line) {
  std::istringstream words(line.substr(std::min(line.size(), line.find(' '))));
  AxisVector values{};
  for (std::size_t i = 0; i < 6; ++i)
    if (!(words >> values[i])) throw MachineError("LinuxCNC reports no six positions: '" + line + "'");
  return values;
}

/// [m] and [rad] of ABS_ACT_POS and REL_ACT_POS.
AxisVector pose_of(const std::string& line) {
  AxisVector words = six_numbers(line);
  for (std::size_t i = 0; i < 6; ++i) words[i] = i < 3 ? from_mm(words[i]) : from_deg(words[i]);
  return words;
}

bool differ(const AxisVector& a, const AxisVector& b) {
  for (std::size_t i = 0; i < 6; ++i)
    if (std::abs(a[i] - b[i]) > (i < 3 ? kPlaceOff : kTurnOff)) return true;
  return false;
}

std::string text_of(const AxisVector& words) {
  return fmt::format("X{:.4f} Y{:.4f} Z{:.4f} A{:.4f} B{:.4f} C{:.4f}", to_mm(words[0]), to_mm(words[1]),
                     to_mm(words[2]), to_deg(words[3]), to_deg(words[4]), to_deg(words[5]));
}

}  // namespace

/// Sends the lines and waits for an answer that begins so; what else is said is read away.
std::string LinuxcncSession::exchange(const std::string& lines, const std::string& begin, double seconds) {
  const double deadline = link_.now() + seconds;
  outgoing_ += lines;
  std::string last;
  while (link_.now() < deadline) {
    write_out();
    link_.wait(std::min(deadline, link_.now() + 0.02));
    while (const auto line = next_line()) {
      if (line->starts_with("JOINT_POS")) take_joints(*line);
      if (line->ends_with("NAK") || line->ends_with("Nak"))
        throw MachineError("LinuxCNC refuses: it says '" + *line + "'");
      if (line->starts_with(begin)) return *line;
      last = *line;
    }
  }
  throw MachineError(fmt::format("no linuxcncrsh answers '{}' within {:g} s{}",
                                 lines.substr(0, lines.find('\r')), seconds,
                                 last.empty() ? "" : ": it says '" + last.substr(0, 80) + "'"));
}

void LinuxcncSession::switch_on() {
  if (exchange("get estop\r\n", "ESTOP ", options_.reply_time) == "ESTOP ON")
    exchange("set estop off\r\n", "SET ESTOP", options_.reply_time);
  exchange("set machine on\r\n", "SET MACHINE", options_.reply_time);
  for (const double until = link_.now() + options_.reply_time;
       exchange("get machine\r\n", "MACHINE ", options_.reply_time) != "MACHINE ON";) {
    if (link_.now() > until)
      throw MachineError("LinuxCNC does not switch the machine on: is an emergency stop pressed?");
    link_.wait(link_.now() + kAgain);
  }
}

/// What is homed stays so: homing counts from where the machine stands.
void LinuxcncSession::home() {
  const auto homed = [this] {
    return exchange("get joint_homed\r\n", "JOINT_HOMED", options_.reply_time).find("NO") ==
           std::string::npos;
  };
  if (homed()) return;
  if (!options_.home) throw MachineError("the machine is not homed: home it, or say home=yes in the URI");
  exchange("set mode manual\r\n", "SET MODE", options_.reply_time);
  exchange("set home -1\r\n", "SET HOME", options_.reply_time);
  for (const double until = link_.now() + kHomeTime; !homed();) {
    if (link_.now() > until) throw MachineError(fmt::format("it is not homed within {:g} s", kHomeTime));
    link_.wait(link_.now() + kAgain);
  }
}

void LinuxcncSession::set_modes() {
  exchange("set mode mdi\r\n", "SET MODE", options_.reply_time);
  exchange("set mdi G21 G90 G40 G49 G80 G54 G93 G64 P0.002 Q0\r\n", "SET MDI", options_.reply_time);
  for (int i = 0; i < kErrorsMost; ++i)  // those of before
    if (exchange("get error\r\n", "ERROR ", options_.reply_time) == "ERROR OK") return;
}

/// Its pose at its joints is ours, and words are counted from its machine's zero.
void LinuxcncSession::check_kinematics() {
  exchange("get joint_pos\r\n", "JOINT_POS", options_.reply_time);
  const AxisVector theirs = pose_of(exchange("get abs_act_pos\r\n", "ABS_ACT_POS", options_.reply_time));
  const AxisVector ours = words_.of_axes(position_);
  if (words_.lost() || differ(theirs, ours))
    throw MachineError(
        fmt::format("LinuxCNC has the kinematics of another machine: where it stands it says {}, "
                    "and the machine file {}; write its configuration by understudy export linuxcnc",
                    text_of(theirs), words_.lost() ? "no pose" : text_of(ours)));
  const AxisVector counted = pose_of(exchange("get rel_act_pos\r\n", "REL_ACT_POS", options_.reply_time));
  if (differ(theirs, counted))
    throw MachineError("LinuxCNC has a work offset or G92 set: clear it (G54 of zeros, G92.1, G49)");
}

void LinuxcncSession::connect() {
  exchange("hello EMC understudy 1.0\r\n", "HELLO ACK", options_.boot_time);
  exchange("set enable EMCTOO\r\nset echo off\r\nset verbose on\r\n", "SET VERBOSE ACK", options_.reply_time);
  exchange("set set_wait received\r\n", "SET SET_WAIT", options_.reply_time);
  switch_on();
  home();
  set_modes();
  check_kinematics();
  push_rest(position_);
}

}  // namespace understudy::drivers
