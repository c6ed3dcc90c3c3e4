// A machine behind a controller that reads G-code: setpoints go through the queue that lies under every port,
// become blocks, and are sent ahead of their time by a fixed latency.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/driver_port.h"
#include "drivers/gcode/block_fitter.h"
#include "drivers/gcode/byte_link.h"
#include "drivers/gcode/controller.h"
#include "drivers/gcode/gcode_session.h"
#include "drivers/gcode/gcode_words.h"
#include "drivers/gcode/linuxcnc_session.h"
#include "drivers/gcode/path_sampler.h"
#include "drivers/pose_words.h"
#include "machine/description.h"

namespace understudy::drivers {

struct GcodeSetup {
  GcodeFamily family = GcodeFamily::grblhal;
  GcodeAxes axes;
  SessionOptions session;
  FitTolerance tolerance;
  double latency = 0.25;  ///< [s], by which the machine is behind the port's clock: its lookahead
  bool outputs = true;    ///< the controller has a heater and a fan
  std::size_t queue_capacity = 4096;
  AnotherLink another;  ///< of LinuxCNC
};

/// Of the options of a URI. Throws InputError for one that is unknown or out of its range.
GcodeSetup gcode_setup(const PortUri& uri, const machine::MachineDescription& machine);

/// The port's clock runs with the link's inside wait_until(), and stands while the controller heats up or
/// cannot take more. I/O is done inside wait_until() and urgent() alone. There is no camera.
class GcodePort : public DriverPort {
 public:
  /// Connects. The description need not outlive the port. Throws MachineError where the controller does not
  /// answer or is another one.
  GcodePort(std::unique_ptr<ByteLink> link, const GcodeSetup& setup,
            const machine::MachineDescription& machine);

  int axis_count() const override { return setup_.axes.count(); }
  double now() const override { return now_; }
  machine::AxisState state() const override;
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  machine::Status urgent(machine::UrgentCommand command) override;
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override;
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;
  std::string fault_text() const override { return fault_text_; }
  void emergency_stop() override;

 private:
  bool step(double until);
  bool time_stands() const;
  void release(double until);
  void hand_over(bool all);
  void raise(machine::Fault fault, const std::string& why);
  void end_of_motion();
  void settle();

  GcodeSetup setup_;
  std::unique_ptr<ByteLink> link_;
  std::unique_ptr<PoseWords> words_;  ///< null: the controller's coordinates are the axes
  std::unique_ptr<Controller> controller_;
  PathSampler path_;
  BlockFitter fitter_;
  std::vector<Block> held_;      ///< until the controller has enough ahead
  double held_time_ = 0;         ///< [s], of these
  bool streaming_ = false;       ///< the controller has work: blocks go on at once
  double now_ = 0, anchor_ = 0;  ///< [s]; link's clock = anchor_ + now_, unless it is ahead
  double stood_from_ = 0;        ///< [s], the anchor when the clock last ran
  machine::Outputs outputs_;
  bool heating_ = false;
  machine::Fault fault_ = machine::Fault::none;
  std::string fault_text_;
};

/// serial:// and tcp://.
std::unique_ptr<GcodePort> open_gcode(const PortUri& uri, const machine::MachineDescription& machine);

}  // namespace understudy::drivers
