// Closes the initial deposition gap (Song 2015, 3.3): from S' towards the surface in one direction, with a
// sample at every stop, until the gap is the aim. It never touches: a step is a fraction of what is left
// above the aim, and no dot, a saturated, implausible or stale image stops it, retreats and says why.
#pragma once

#include <string>
#include <vector>

#include "control/gap/gap_reading.h"
#include "control/gap/gap_stop.h"
#include "machine/port.h"

namespace understudy::control {

/// Gains and limits, by default those of a machine file that does not say.
struct GapControllerOptions : machine::GapApproachSettings {
  double aim = 0;  ///< [m]; 0 takes the machine's
};

/// The machine's own gains and limits, and its aim.
GapControllerOptions gap_controller_options(const machine::MachineDescription& machine);

/// One frame: what was seen and what it was taken for.
struct GapSample {
  double time = 0;  ///< [s], middle of the exposure
  vision::DotMeasurement dot;
  GapReading reading;
  bool used = false;  ///< false: discarded, see `why`
  std::string why;
  machine::Frame frame;
  double believed = 0;        ///< [m], the gap at this time as estimated from all frames up to this one
  double believed_sigma = 0;  ///< [m], of noise, path and calibration; 0: there is no estimate yet
};

struct GapOutcome {
  GapStop stop = GapStop::none;  ///< none: the aim was reached
  std::string why;               ///< one line for the operator
  double gap = 0;                ///< [m], last accepted reading
  double sigma = 0;              ///< [m], of its noise
  double calibration_sigma = 0;  ///< [m], that all readings share: what the sensor's calibration leaves
  Vec3 offset_W{0, 0, 0};        ///< [m], to be carried: commanded tip minus programmed S
  std::vector<GapSample> samples;
};

/// What the controller may do to the machine while it approaches: straight moves along the tool axis.
class GapMotion {
 public:
  virtual ~GapMotion() = default;
  /// Moves the tip to X_WT and waits until it rests there.
  virtual machine::Status move_to(const Pose& X_WT) = 0;
  virtual machine::MachinePort& port() = 0;
};

/// `X_WT_start` is S (programmed), the tool rests at S' = S + standoff along its axis.
GapOutcome close_gap(const machine::MachineDescription& machine, const LocalSurface& surface,
                     const Pose& X_WT_start, double standoff, GapMotion& motion,
                     const GapControllerOptions& options);

}  // namespace understudy::control
