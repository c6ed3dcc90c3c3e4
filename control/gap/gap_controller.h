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

struct GapControllerOptions {
  double aim = 0;               ///< [m]; 0 takes the machine's
  double tolerance = 8e-6;      ///< [m], stop when the reading is this near to the aim
  double step_fraction = 0.7;   ///< of the distance left, while farther than `slow_zone`
  double slow_zone = 0.15e-3;   ///< [m], above the aim: frames are averaged and steps shortened here
  int frames_averaged = 3;      ///< in the slow zone; the tip creeps between them, so speckle changes
  int stops_max = 40;           ///< steps before giving up
  double residual_max_px = 12;  ///< farther off its line, the dot is implausible
  double depth_max = 4e-3;    ///< [m], below S: a surface that lies lower is not the one that was programmed
  double settle_time = 0.05;  ///< [s], rest before an exposure
  double frame_age_max = 0.25;  ///< [s]
  double retreat = 2e-3;        ///< [m], along the tool axis, after a stop for a reason
};

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
