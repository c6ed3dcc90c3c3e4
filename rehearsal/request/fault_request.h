// What shall go wrong in a rehearsal, told with axis names and resolved once the machine is known.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "sim/faults/camera_faults.h"
#include "sim/faults/faults.h"

namespace understudy::rehearsal {

struct FaultRequest {
  sim::FaultEvent event;  ///< without its axis
  std::string axis;       ///< name; empty for a power cut
  bool angle = false;     ///< the amount is given as an angle
  Place place;            ///< in the file that asks for it
};

struct CameraFaultRequest {
  sim::CameraFaultEvent event;
  Place place;  ///< in the file that asks for it
};

/// Throws InputError at the request's place for an axis that the machine does not have, an amount of the
/// wrong unit, and everything that sim::check_faults refuses.
std::vector<sim::FaultEvent> resolve_faults(const std::vector<FaultRequest>& requests,
                                            const machine::MachineDescription& machine);

/// Likewise for a machine without a camera, and everything that sim::check_camera_faults refuses.
std::vector<sim::CameraFaultEvent> resolve_camera_faults(const std::vector<CameraFaultRequest>& requests,
                                                         const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
