// How a session begins: who answers, whether it is the controller that was named, and where it stands.
#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "drivers/gcode/gcode_session.h"

namespace understudy::drivers {
namespace {

constexpr double kAgain = 1.0;     // [s], between two questions
constexpr double kHomeTime = 180;  // [s], for all axes
constexpr double kQuiet = 0.3;     // [s]
constexpr char kReset = 0x18;

}  // namespace

/// Sends a line of its own, again and again, until a reply of that kind comes.
std::string GcodeSession::exchange(const std::string& line, double seconds, Reply::Kind until) {
  const double deadline = link_.now() + seconds;
  double again = link_.now();
  std::string last;
  while (link_.now() < deadline) {
    if (link_.now() >= again) {
      outgoing_ += line;
      again = seconds == kHomeTime ? deadline : link_.now() + kAgain;  // homing is asked for once
    }
    write_out();
    link_.wait(std::min(deadline, link_.now() + 0.02));
    while (const auto reply = next_reply()) {
      if (reply->text.starts_with("FIRMWARE_NAME:")) firmware_ = reply->text;
      if (reply->kind == Reply::Kind::position) take_position(*reply);
      if (reply->kind == Reply::Kind::status) greet_status(reply->status, until);
      if (reply->kind == until) return reply->text;
      last = reply->text;
    }
  }
  throw MachineError(fmt::format("no {} controller answers within {:g} s{}", to_string(writer_.family()),
                                 seconds, last.empty() ? "" : ": it says '" + last.substr(0, 80) + "'"));
}

void GcodeSession::greet_status(const ControllerStatus& status, Reply::Kind until) {
  if (status.state != "Alarm") return take_status(status);
  if (until == Reply::Kind::status)
    throw MachineError("the controller is in alarm: home it (home=yes in the URI), or unlock it there");
}

void GcodeSession::greet_counting() {
  exchange(std::string(1, kReset), options_.boot_time, Reply::Kind::banner);
  if (options_.home) exchange("$H\n", kHomeTime, Reply::Kind::ok);
  exchange("?", options_.reply_time, Reply::Kind::status);
  for (int i = 0; i < 3 && work_offset_.empty(); ++i) exchange("?", options_.reply_time, Reply::Kind::status);
}

void GcodeSession::greet_numbering() {
  exchange("\nM110 N0\n", options_.boot_time, Reply::Kind::ok);
  // What an earlier question was answered with late is read away.
  const double quiet = link_.now() + kQuiet;
  while (link_.now() < quiet) {
    link_.wait(quiet);
    while (next_reply()) {
    }
  }
  exchange("M115\n", options_.reply_time, Reply::Kind::ok);
  const char* name = writer_.family() == GcodeFamily::marlin ? "Marlin" : "RepRapFirmware";
  if (firmware_.find(name) == std::string::npos)
    throw MachineError(fmt::format("the controller is no {}: it says '{}'", name, firmware_.substr(0, 80)));
  if (options_.home) exchange("G28\n", kHomeTime, Reply::Kind::ok);
  exchange("M114\n", options_.reply_time, Reply::Kind::position);
  exchange("", options_.reply_time, Reply::Kind::ok);
}

void GcodeSession::connect() {
  if (counts())
    greet_counting();
  else
    greet_numbering();
  if (fault() != machine::Fault::none) throw MachineError(fault_text());
  if (!position_fresh_)
    throw MachineError(fmt::format("the controller does not report the axes {}", writer_.axes().letters));
  heard_ = link_.now();
  for (const std::string& line : writer_.preamble()) push(line, 0, 0);
  push_rest(position_);
}

}  // namespace understudy::drivers
