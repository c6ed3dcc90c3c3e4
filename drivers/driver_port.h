// What a port of a real machine can do besides MachinePort: for who stands beside the machine.
#pragma once

#include <string>

#include "machine/port.h"

namespace understudy::drivers {

class DriverPort : public machine::MachinePort {
 public:
  /// One line for the operator: what the machine said when the fault came that stands; empty without one.
  virtual std::string fault_text() const = 0;
  /// At once, whatever is queued: power to motors and heaters off where the machine can. The port then has
  /// the fault emergency_stop, which is not cleared.
  virtual void emergency_stop() = 0;
};

}  // namespace understudy::drivers
