// What the machine file states of a clamped part and of the machine, as the registration's fit takes it
// (docs/registration.md#the-fit).
#pragma once

#include <vector>

#include "control/registration/part_fit.h"
#include "control/registration/probing_place.h"
#include "machine/built_tolerances.h"
#include "machine/description.h"

namespace understudy::control {

/// Of a file that states no pose tolerance of the part: a part clamped by hand, against stops or in a vice.
PartTolerance part_tolerance(const machine::BuiltTolerances& stated);

/// 1 sigma [m] of one place beside its reading's noise. The errors that the machine and the part's waves make
/// alike at all places go into the pose; the rest differs from place to place and grows with the RMS distance
/// of the places from their centre, up to a limit of each.
double place_sigma(const machine::BuiltTolerances& stated, const machine::MachineDescription& machine,
                   const std::vector<ProbingPlace>& places);

}  // namespace understudy::control
