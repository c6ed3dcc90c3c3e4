// Why a print ends before its end: carried as it is from where it arose to the report.
#pragma once

#include <string>

#include "control/gap/gap_stop.h"
#include "machine/port.h"

namespace understudy::control {

struct [[nodiscard]] Stop {
  machine::Status status = machine::Status::ok;  ///< what the port answered
  machine::Fault fault = machine::Fault::none;   ///< that stood then
  GapStop gap = GapStop::none;                   ///< what the gap controller found
  std::string why;                               ///< one line for the operator
  int line = 0;                                  ///< of the G-code
  double time = 0;                               ///< [s], port clock

  /// True: stop. False: go on.
  explicit operator bool() const { return status != machine::Status::ok || gap != GapStop::none; }
};

/// Of a call of the port: nothing for Status::ok.
Stop stop_of(machine::Status answer, const machine::MachinePort& port);

/// Of the gap controller: "no dot: 12 frames ...", and the fault that stands, if there is one.
Stop stop_of(GapStop reason, const std::string& why, const machine::MachinePort& port);

}  // namespace understudy::control
