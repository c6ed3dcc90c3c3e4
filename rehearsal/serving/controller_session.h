// What a sender hears: bytes in, bytes out, in the words of a family of controllers.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/printable.h"
#include "rehearsal/serving/served_machine.h"

namespace understudy::rehearsal {

class ControllerSession {
 public:
  virtual ~ControllerSession() = default;
  /// What a controller says when a sender opens the line.
  virtual void greet() = 0;
  /// Bytes that its receive buffer still takes; a sender that sends more has to wait.
  virtual std::size_t room() const = 0;
  virtual void receive(std::string_view bytes) = 0;
  /// The machine's clock shows `now` [s]: lines go on into the planner and are answered.
  virtual void tick(double now) = 0;
  /// Nothing more will be answered by itself.
  virtual bool quiet() const = 0;
  /// The sender has ended the print for good (a reset while it moves, M112).
  virtual bool aborted() const = 0;
  /// What is to be sent by now.
  std::string take_output();

 protected:
  /// One line, whatever of the sender's own words it repeats.
  void say(const std::string& line) { out_ += printable(line) + "\r\n"; }

 private:
  std::string out_;
};

/// Words of --dialect.
const std::vector<std::string>& session_dialects();
/// Moves that the planner of such a controller holds.
int planner_blocks(const std::string& dialect);
/// Throws InputError for another word. `machine` must outlive it.
std::unique_ptr<ControllerSession> make_session(const std::string& dialect, ServedMachine& machine);

std::unique_ptr<ControllerSession> make_grbl_session(ServedMachine& machine);
std::unique_ptr<ControllerSession> make_marlin_session(ServedMachine& machine);

}  // namespace understudy::rehearsal
