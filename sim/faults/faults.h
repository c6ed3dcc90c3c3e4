// What goes wrong with a machine while it works, at a stated time (docs/faults.md).
//
// Steppers are not watched by an encoder: after a fault the port goes on counting the steps that it asked
// for, and the controller learns nothing. Only a power cut ends a print by itself.
#pragma once

#include <string>
#include <vector>

#include "machine/description.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

enum class FaultKind {
  lost_steps,      ///< the rotor slips by whole electrical cycles (4 full steps) as it moves
  stall,           ///< the rotor stands still for a while, then catches the nearest cycle
  disconnected,    ///< the motor has no current any more
  loose_joint,     ///< the axis' play grows at once
  thermal_growth,  ///< the axis grows, linearly over a while, beyond what its drive reads
  power_cut        ///< no motor has current; the controller hears Fault::power
};
const char* to_string(FaultKind kind);

struct FaultEvent {
  FaultKind kind = FaultKind::stall;
  int axis = 0;         ///< without meaning for a power cut
  double time = 0;      ///< [s], port clock
  int steps = 0;        ///< lost_steps: full steps, a positive multiple of 4
  double duration = 0;  ///< [s], of a stall or a growth
  double amount = 0;    ///< [m] or [rad]: more play of a loose joint, more growth
};

/// A motor's electrical cycle: what a stepper slips by. [full steps]
constexpr int kElectricalCycle = 4;

/// "stall of axis l3 at 2.500 s for 0.400 s"
std::string describe(const FaultEvent& event, const machine::MachineDescription& machine);

/// Throws InputError for an event that the machine cannot have: an axis it does not have, a negative time,
/// steps that are no multiple of a cycle, a joint without play that shall come loose, an endless growth.
void check_faults(const std::vector<FaultEvent>& events, const machine::MachineDescription& machine);

/// Stands between the commands of a port and the drives. Allocation-free once made.
class FaultyDrives {
 public:
  FaultyDrives(const machine::MachineDescription& machine, std::vector<FaultEvent> events);

  /// Changes the commands of the drives, and the plant's condition, as the events up to `time` say.
  void apply(double time, DriveCommand& command, Plant& plant);
  /// True once the power is gone.
  bool power_is_cut() const { return power_cut_; }
  /// True where the drive no longer follows its commands: the port then counts steps, not motion.
  bool counts_only(int axis) const { return axes_[static_cast<std::size_t>(axis)].counts_only; }

 private:
  struct Axis {
    double slip = 0;   ///< [m] or [rad], command minus what the rotor does
    double cycle = 0;  ///< [m] or [rad], travel in an electrical cycle
    int stalls = 0;    ///< under way
    double slip_wanted =
        0;                 ///< [m] or [rad], of lost steps, at which the rotor catches again; 0: none are due
    double frozen_at = 0;  ///< [m] or [rad]
    bool counts_only = false;
    AxisCondition condition;
    bool frozen() const { return stalls > 0 || slip_wanted > 0; }
  };
  void begin(const FaultEvent& event, const DriveCommand& command, Plant& plant);
  void slip(Axis& axis, double& position, double& velocity) const;
  void release(int axis, Plant& plant);

  std::vector<FaultEvent> events_;  ///< by time
  std::size_t next_ = 0;
  std::vector<Axis> axes_;
  struct Growth {
    FaultEvent event;
    double done = 0;  ///< [m] or [rad], of its amount
  };
  std::vector<FaultEvent> stalls_;  ///< under way
  std::vector<Growth> growths_;     ///< under way
  bool power_cut_ = false;
};

}  // namespace understudy::sim
