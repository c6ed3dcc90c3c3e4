// A machine's port with a camera that is not the machine's own.
#pragma once

#include <memory>

#include "drivers/camera/frame_source.h"
#include "machine/load_reading.h"
#include "machine/port.h"

namespace understudy::drivers {

/// What the camera did [s].
struct CameraUse {
  std::uint64_t used = 0;     ///< frames that capture() returned
  std::uint64_t dropped = 0;  ///< exposures that are missing between frames, by their stamps
  double oldest = 0;          ///< [s], age of a frame when it was returned, at most
};

/// All but capture() goes to the port. capture() returns the first frame that was exposed after the call,
/// while the port's time passes; its stamp is carried to the port's clock by its age. A frame that is older
/// is never returned. no_frame: the camera has ended; deadline_exceeded: no frame came in time.
class CameraPort : public machine::MachinePort, public machine::LoadSide {
 public:
  /// The port must outlive this object.
  CameraPort(machine::MachinePort& port, std::unique_ptr<FrameSource> source)
      : port_(port), source_(std::move(source)) {}

  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  machine::AxisState state() const override { return port_.state(); }
  bool read_load(machine::LoadReading& reading) const override { return machine::read_load(port_, reading); }
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override {
    return port_.submit(setpoints, deadline);
  }
  machine::Status wait_until(double time) override { return port_.wait_until(time); }
  machine::Status urgent(machine::UrgentCommand command) override { return port_.urgent(command); }
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override {
    return port_.set_outputs(outputs, deadline);
  }
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;

  const CameraUse& use() const { return use_; }

 private:
  void watch_stamps(const TimedImage& image);

  machine::MachinePort& port_;
  std::unique_ptr<FrameSource> source_;
  CameraUse use_;
  double last_stamp_ = 0, interval_ = 0;  // [s]; the shortest between two exposures
  std::uint64_t last_number_ = 0;
  bool seen_ = false;
};

}  // namespace understudy::drivers
