// A plant whose drives turn motors: travel of the axis is not that of a perfect screw.
#pragma once

#include <memory>

#include "sim/plant/plant.h"

namespace understudy::sim {

/// Commands and displacement() of the plant that comes back are the motors'; `plant`, where it is null or the
/// drives have no errors, comes back itself.
std::unique_ptr<Plant> with_drive_errors(std::unique_ptr<Plant> plant,
                                         const machine::MachineDescription& machine, const AsBuilt& built);

/// [m] or [rad], travel of the axis where its motor has turned by `motor` [of travel] from the reading 0.
double axis_travel(const DriveError& error, double lead, double motor);
/// Its inverse, to 1e-12 of a lead.
double motor_travel(const DriveError& error, double lead, double axis);

}  // namespace understudy::sim
