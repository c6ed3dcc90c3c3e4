// A machine behind LinuxCNC's HAL (docs/linuxcnc.md): setpoints go out a row a servo period, and what the
// drives did comes back the same way. HAL itself runs in processes of its own.
//
// The port's clock counts what was handed to HAL: it runs in wait_until() and capture() alone, as every
// port's, and the machine is up to `lead` behind it while it moves. At rest it waits for the machine, so that
// state() is then fresh; in motion state().sampled_at says how old it is. Between calls a machine that rests
// is kept at rest by repeated rows; one that moves goes on for `lead` and then has run dry.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "drivers/driver_port.h"
#include "machine/description.h"
#include "machine/load_reading.h"

namespace understudy::drivers {

struct HalPortOptions {
  std::string folder;        ///< of `understudy export hal`; empty: HAL runs already
  double lead = 0.2;         ///< [s], of rows under way; how late this process may be, and every command is
  double frame_time = 0.02;  ///< [s], exposure plus transfer of `frames`
  /// Fills the image for what the machine does; false: no frame. Empty: no camera.
  std::function<bool(const machine::AxisState&, const Region&, Image&)> frames;
};

/// Since the port was opened.
struct HalCounts {
  std::uint64_t rows = 0;       ///< handed to HAL
  std::uint64_t pauses = 0;     ///< of these, repeated while the machine rested and no time passed
  std::uint64_t underruns = 0;  ///< servo periods without a row while the machine was on
};

class HalPort : public DriverPort, public machine::LoadSide {
 public:
  /// Throws as HalSession does. The machine is on afterwards, or a fault stands that says why not.
  HalPort(const machine::MachineDescription& machine, const HalPortOptions& options);
  /// Brakes; the watchdog then switches the machine off. A HAL that the port started ends with it.
  ~HalPort() override;
  HalPort(const HalPort&) = delete;
  HalPort& operator=(const HalPort&) = delete;

  int axis_count() const override;
  double now() const override;
  machine::AxisState state() const override;
  bool read_load(machine::LoadReading& reading) const override;
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  /// clear_fault switches the machine on again and waits for it, some lead; the axes rest where they are.
  machine::Status urgent(machine::UrgentCommand command) override;
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override;
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;

  /// One line for the operator: why the fault stands; empty without one.
  std::string fault_text() const override;
  /// Opens HAL's emergency-stop latch at once, whatever is queued: heater and fan off, brake, drives off.
  void emergency_stop() override;
  HalCounts counts() const;

 private:
  class Link;
  std::unique_ptr<Link> link_;
  HalPortOptions options_;
  machine::Frame last_frame_;
  std::uint64_t frames_delivered_ = 0;
};

/// `hal://FOLDER` starts the configuration there, `hal://` takes the one that runs; `?lead_ms=N` (20..5000).
/// Throws InputError for another URI.
HalPortOptions hal_port_options(const std::string& uri);

/// Opens the port of a URI. The description need not outlive it.
std::unique_ptr<machine::MachinePort> open_hal_port(const std::string& uri,
                                                    const machine::MachineDescription& machine);

}  // namespace understudy::drivers
