// The `faults` of a scenario: what shall go wrong, told with axis names, resolved once the machine is known.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "sim/faults/faults.h"

namespace understudy::rehearsal {

class StrictMap;

struct FaultRequest {
  sim::FaultEvent event;  ///< without its axis
  std::string axis;       ///< name; empty for a power cut
  bool angle = false;     ///< the amount is given as an angle
  Place place;            ///< in the scenario file
};

/// The list under `faults`. Throws InputError with file and line.
std::vector<FaultRequest> read_faults(StrictMap& scenario);

/// Throws InputError at the request's place for an axis that the machine does not have, an amount of the
/// wrong unit, and everything that sim::check_faults refuses.
std::vector<sim::FaultEvent> resolve_faults(const std::vector<FaultRequest>& requests,
                                            const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
