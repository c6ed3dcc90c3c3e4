// What the controller holds of the gap along a print, and how sure it says it is: from its own frames, its
// description and the calibration in its machine file. The truth has no part in it.
#pragma once

#include <string>
#include <vector>

#include "control/print.h"
#include "machine/calibrated_parameters.h"
#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// An instant of a print as it was commanded.
struct CommandedInstant {
  double time = 0;  ///< [s]
  bool extruding = false;
  Pose X_WT = Pose::Identity();  ///< programmed
};

/// What the controller knows. All of it outlives the call.
struct GapKnowledge {
  const machine::MachineDescription& machine;
  const machine::CalibratedParameters& parameters;  ///< of the machine's file; may hold no covariance
  control::GapControl mode = control::GapControl::off;
  const control::PrintResult& result;
};

/// One belief for each instant, in order of time; NaN sigma while nothing is extruded.
///  - Without gap control: the commanded gap, as sure as the calibrated geometry puts the tip along the axis.
///  - From an approach on: what it read at the start, with the noise of its estimate and what the sensor's
///    calibration leaves; along the bead also what the calibrated geometry leaves of the tip against the
///    start. Without a covariance of the geometry it states the start's alone, all along.
///  - Where it is followed: the estimate of each frame and its sigma, straight lines between frames.
std::vector<GapBelief> gap_beliefs(const GapKnowledge& knowledge,
                                   const std::vector<CommandedInstant>& instants);

/// Where the sigma comes from, in words for people.
std::string how_stated(const GapKnowledge& knowledge);

}  // namespace understudy::rehearsal
