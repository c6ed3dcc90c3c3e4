// The only way a controller sees a machine. The twin and the hardware both stand behind it.
//
// Accepted is not executed: submit() answers whether setpoints were queued, state() what has been done.
// Time is the port's own clock [s]; simulated time advances only inside wait_until() and capture().
// Calls in the control cycle do not throw, allocate, lock or do I/O; they return a Status to be looked at.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/image.h"
#include "kinematics/mechanism.h"

namespace understudy::machine {

using kinematics::AxisVector;
using kinematics::kMaxAxes;

enum class [[nodiscard]] Status{
    ok,
    queue_full,         ///< nothing of the call was queued; wait and call again
    deadline_exceeded,  ///< the port's clock passed the deadline before the call could finish
    faulted,            ///< a sticky fault stands; see AxisState::fault
    rejected,  ///< the request itself is wrong (time not increasing, not finite, beyond the axis range)
    no_frame,  ///< the camera delivered nothing
};
const char* to_string(Status s);

/// Sticky until clear_fault(): a port with a fault takes no setpoints.
enum class Fault { none, following_error, underrun, limit_switch, drive, emergency_stop, power, engine };
const char* to_string(Fault f);

/// A hold or stop brings the axes to rest within this time, along what is queued: at the full speed of the
/// hexapod (60 mm/s) well below its drives' acceleration.
constexpr double kBrakingTime = 0.1;  // [s]

/// Where the axes shall be at a time. Between setpoints the port interpolates with position and velocity.
struct Setpoint {
  double time = 0;        ///< [s], port clock
  AxisVector position{};  ///< [m or rad]; hexapod: strut lengths by the controller's geometry
  AxisVector velocity{};  ///< [m/s or rad/s]
  double filament = 0;    ///< [m], filament fed since the start, absolute
  int line = 0;           ///< G-code line that this serves
};

struct AxisState {
  double time = 0;             ///< [s], port clock now
  double sampled_at = 0;       ///< [s], when position was measured; age = time - sampled_at
  AxisVector position{};       ///< measured by the drives, SI
  std::uint64_t accepted = 0;  ///< setpoints queued since the start
  std::uint64_t executed = 0;  ///< setpoints whose time has passed
  std::size_t free_slots = 0;  ///< room in the queue
  bool moving = false;
  Fault fault = Fault::none;
};

enum class UrgentCommand { hold, resume, stop, clear_fault };

struct Outputs {
  double nozzle_temperature = 0;  ///< [K]; 0 = heater off
  double fan = 0;                 ///< 0..1

  bool off() const { return nozzle_temperature == 0 && fan == 0; }
};

struct Frame {
  Image image;
  double exposed_at = 0;     ///< [s], middle of the exposure, port clock
  double received_at = 0;    ///< [s]; age = received_at - exposed_at
  std::uint64_t number = 0;  ///< counts exposures; a repeated number is a stale frame
};

class MachinePort {
 public:
  virtual ~MachinePort() = default;

  virtual int axis_count() const = 0;
  virtual double now() const = 0;
  virtual AxisState state() const = 0;

  /// All or nothing. Times must increase strictly.
  virtual Status submit(std::span<const Setpoint> setpoints, double deadline) = 0;
  /// Lets time pass until the clock shows `time` (or a fault stops it).
  virtual Status wait_until(double time) = 0;
  /// Bypasses the queue. hold: decelerate and keep the rest of the queue until resume; stop: decelerate and
  /// drop it; clear_fault.
  virtual Status urgent(UrgentCommand command) = 0;
  /// With a fault, outputs can only be switched off.
  virtual Status set_outputs(const Outputs& outputs, double deadline) = 0;
  /// Exposes one frame of the tool's microscope and waits for it. `region` is clipped to the sensor.
  virtual Status capture(const Region& region, Frame& frame, double deadline) = 0;
};

}  // namespace understudy::machine
