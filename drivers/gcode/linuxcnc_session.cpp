#include "drivers/gcode/linuxcnc_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::drivers {

using machine::AxisVector;
using machine::Fault;

namespace {

constexpr std::size_t kLineMax = 240;  // characters that LinuxCNC takes as one line
constexpr std::size_t kShown = 80;     // characters of a line in a message
constexpr double kPoll = 0.05;         // [s], between two questions for the state
constexpr int kAsksMax = 3;            // for joints that do not stand as expected
constexpr double kReceive = 0.1;       // [s], of linuxcncrsh for one line
constexpr double kPace = 2;            // times the planned duration that LinuxCNC may need

std::string call_of(const std::string& one) { return "set mdi o<understudy_move> call" + one; }
std::string call_of(const std::string& one, const std::string& two) {
  return "set mdi o<understudy_moves> call" + one + two;
}

}  // namespace

LinuxcncSession::LinuxcncSession(ByteLink& link, PoseWords& words, const SessionOptions& options,
                                 AnotherLink another)
    : LineSession(link, options), words_(words), another_(std::move(another)) {}

/// Nothing follows before LinuxCNC has done that line.
void LinuxcncSession::add_waiting(const std::string& line, double duration) {
  add(Role::line, "set set_wait done");
  add(Role::wait, line, duration);
  add(Role::line, "set set_wait received");
}

void LinuxcncSession::begin(const PathSample& at) {
  last_ = {};
  last_.position = at.position;
  last_.filament = at.filament;
}

void LinuxcncSession::push(const Block& block) {
  const double speed = std::abs(block.filament - last_.filament) / block.duration;
  const std::string feeder = fmt::format("[{:.5f}][{:.6g}]", to_mm(block.filament), to_mm(speed));
  if (block.position == last_.position) {
    add(Role::line, fmt::format("set mdi o<understudy_feed> call{}[{:.4f}]", feeder, block.duration),
        block.duration);
  } else {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i) text += fmt::format("[{:.4f}]", to_mm(block.position[i]));
    for (std::size_t i = 3; i < 6; ++i) text += fmt::format("[{:.5f}]", to_deg(block.position[i]));
    add(Role::block, text + fmt::format("[{:.7g}]", 60 / block.duration) + feeder, block.duration);
  }
  entries_.back().executed = std::max(entries_.back().executed, block.executed);
  last_ = block;
}

void LinuxcncSession::push_rest(const AxisVector& position) {
  add_waiting("set mdi G4 P0", 0);
  add(Role::rest, "").expected = position;
}

bool LinuxcncSession::push_outputs(const machine::Outputs& before, const machine::Outputs& after) {
  if (after.fan != before.fan) add(Role::line, fmt::format("set mdi M68 E3 Q{:.4f}", after.fan));
  if (after.nozzle_temperature == before.nozzle_temperature) return false;
  const bool off = after.nozzle_temperature <= 0;
  const double celsius = off ? 0 : after.nozzle_temperature - kCelsiusZero;
  const bool waits = !off && after.nozzle_temperature > before.nozzle_temperature;
  if (waits)
    add_waiting(fmt::format("set mdi o<understudy_heat> call[{:.1f}]", celsius), kHeatTime);
  else
    add(Role::line, fmt::format("set mdi M68 E2 Q{:.1f}", celsius));
  return waits;
}

void LinuxcncSession::handle(const std::string& line) {
  heard_ = link_.now();
  if (line.starts_with("SET ")) {
    if (line.ends_with(" NAK")) {
      refused_ = in_flight_ > 0 ? entries_[accepted_].text.substr(0, kShown) : "a line";
      polled_ = 0;  // the error that it has for it is asked for first
      accept();
    }
    if (line.ends_with(" ACK")) accept();
    return;
  }
  if (line.starts_with("JOINT_POS")) take_joints(line);
  if (line.starts_with("ERROR ") && line != "ERROR OK")
    return fail(Fault::drive, "LinuxCNC says: " + line.substr(6));
  if (line == "ESTOP ON") return fail(Fault::emergency_stop, "LinuxCNC is in emergency stop");
  if (line == "MACHINE OFF") return fail(Fault::drive, "LinuxCNC has switched the machine off");
  if (line.starts_with("MACHINE ")) {
    questions_ = 0;  // the last of a round
    if (!refused_.empty())
      return fail(
          Fault::drive,
          fmt::format("LinuxCNC refuses '{}' and tells no error: its motion took a command too late (the "
                      "computer is too busy), or another program has taken control of linuxcncrsh; "
                      "LinuxCNC's own terminal says more",
                      refused_));
    settle_rest();
  }
}

void LinuxcncSession::accept() {
  accepted_ += in_flight_;
  in_flight_ = 0;
}

/// JOINT_POS 189.292355 ...: in mm.
void LinuxcncSession::take_joints(const std::string& line) {
  std::istringstream words(line.substr(9));
  AxisVector joints{};
  for (std::size_t i = 0; i < kPoseWords; ++i) {
    if (!(words >> joints[i])) return;
    joints[i] = from_mm(joints[i]);
  }
  note_position(words_.axes_of_joints(joints));
}

/// All before the rest is done, and LinuxCNC has just said where its joints stand.
void LinuxcncSession::settle_rest() {
  if (accepted_ >= entries_.size() || entries_[accepted_].role != Role::rest || !position_fresh_) return;
  position_fresh_ = false;
  Entry& entry = entries_[accepted_];
  for (std::size_t i = 0; i < kPoseWords; ++i) {
    if (std::abs(position_[i] - entry.expected[i]) <= options_.step[i]) continue;
    if (++entry.asked >= kAsksMax)
      fail(Fault::following_error, fmt::format("strut {} rests at {:.4f} mm where {:.4f} mm was asked for",
                                               i + 1, to_mm(position_[i]), to_mm(entry.expected[i])));
    return;
  }
  confirm(++accepted_);
}

/// One line at a time; between two of them, and while there is none, questions for the state.
void LinuxcncSession::send_lines() {
  if (in_flight_ > 0 || questions_ > 0 || !outgoing_.empty()) return;
  const bool asks = accepted_ < entries_.size() && entries_[accepted_].role == Role::rest;
  const bool waiting = accepted_ > 0 && entries_[accepted_ - 1].text == "set set_wait done";
  if (!waiting && link_.now() >= polled_ + kPoll) return ask();
  if (asks || accepted_ >= entries_.size()) return;
  const Entry& entry = entries_[accepted_];
  in_flight_ = 1;
  std::string line = entry.text;
  if (entry.role == Role::block) {
    line = call_of(entry.text);
    if (accepted_ + 1 < entries_.size() && entries_[accepted_ + 1].role == Role::block) {
      const std::string both = call_of(entry.text, entries_[accepted_ + 1].text);
      if (both.size() <= kLineMax) {
        line = both;
        in_flight_ = 2;
      }
    }
  }
  heard_ = link_.now();
  outgoing_ += line + "\r\n";
}

void LinuxcncSession::ask() {
  polled_ = heard_ = link_.now();
  position_fresh_ = false;
  questions_ = 1;
  outgoing_ += "get joint_pos\r\nget error\r\nget estop\r\nget machine\r\n";
}

void LinuxcncSession::watch_silence() {
  if (in_flight_ == 0 && questions_ == 0) return;
  double patience = options_.reply_time;
  if (in_flight_ > 0 && entries_[accepted_].role == Role::wait)
    for (std::size_t i = 0; i <= accepted_; ++i) patience += kPace * entries_[i].duration + kReceive;
  if (link_.now() - heard_ > patience)
    fail(Fault::power, fmt::format("LinuxCNC has not answered for {:.1f} s", link_.now() - heard_));
}

/// LinuxCNC drops what it has to do, and switches both off. Nothing counts on it.
void LinuxcncSession::outputs_off() {
  try {
    const std::string lines =
        "\r\nset set_wait received\r\nset abort\r\nset mode mdi\r\nset mdi M68 E2 Q0\r\nset mdi M68 E3 "
        "Q0\r\n";
    static_cast<void>(link_.send(lines));
  } catch (const MachineError&) {  // it is gone, and the fault that stands says so
  }
}

/// By a connection of its own: the first may be waiting for a rest. The configuration switches heater and fan
/// off with the machine.
void LinuxcncSession::emergency_stop() {
  constexpr double kWithin = 1.0;  // [s]
  try {
    static_cast<void>(link_.send("set estop on\r\n"));
    if (!another_) return;
    const auto link = another_();
    static_cast<void>(
        link->send("hello EMC understudy 1.0\r\nset enable EMCTOO\r\nset estop on\r\nget estop\r\n"));
    std::string heard;
    std::array<char, 256> bytes;
    for (const double until = link->now() + kWithin;
         link->now() < until && heard.find("ESTOP ON") == std::string::npos;) {
      link->wait(std::min(until, link->now() + 0.02));
      heard.append(bytes.data(), link->receive(bytes));
    }
  } catch (const std::runtime_error&) {  // it is gone
  }
}

}  // namespace understudy::drivers
