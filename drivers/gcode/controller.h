// A controller that is sent blocks ahead of their time, and says later what it has done.
//
// Pushing only queues. I/O is done in pump(), connect(), outputs_off() and emergency_stop(); none but
// connect() throws: a link that is gone is a fault.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/gcode/block_fitter.h"
#include "machine/port.h"

namespace understudy::drivers {

constexpr double kHeatTime = 600;  // [s], to any temperature

class Controller {
 public:
  virtual ~Controller() = default;

  /// Waits for the controller, makes sure what it is, homes it where that is asked for, and reads where it
  /// stands. Throws MachineError where it does not answer, is another one, or has a fault.
  virtual void connect() = 0;
  /// From here, in the controller's coordinates, the next block starts.
  virtual void begin(const PathSample& at) = 0;
  virtual void push(const Block& block) = 0;
  /// What was pushed ends at rest with the axes there. What follows waits until the controller says so.
  virtual void push_rest(const machine::AxisVector& position) = 0;
  /// True: what follows waits until the nozzle is hot.
  virtual bool push_outputs(const machine::Outputs& before, const machine::Outputs& after) = 0;
  /// Reads and sends what can be read and sent now.
  virtual void pump() = 0;
  /// After a fault, past everything: heater and fan, whatever they were.
  virtual void outputs_off() = 0;
  virtual void emergency_stop() = 0;

  virtual bool settled() const = 0;                         ///< all that was pushed is done
  virtual double backlog() const = 0;                       ///< [s], by which it takes less than it is sent
  virtual std::uint64_t executed() const = 0;               ///< setpoints
  virtual const machine::AxisVector& position() const = 0;  ///< [m or rad], of the axes, as reported last
  virtual double position_time() const = 0;                 ///< [s], clock of the link
  virtual machine::Fault fault() const = 0;
  virtual const std::string& fault_text() const = 0;
  virtual void fail(machine::Fault fault, const std::string& why) = 0;
};

}  // namespace understudy::drivers
