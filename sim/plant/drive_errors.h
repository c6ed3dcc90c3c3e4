// A plant whose drives turn motors: travel of the axis is not that of a perfect screw.
#pragma once

#include <memory>

#include "sim/plant/plant.h"

namespace understudy::sim {

/// A plant whose commands and displacement() are those of the motors. Returns `plant` itself where it is null
/// or no drive of `built` has an error.
std::unique_ptr<Plant> with_drive_errors(std::unique_ptr<Plant> plant,
                                         const machine::MachineDescription& machine, const AsBuilt& built);

/// [m] or [rad], travel of the axis where its motor has turned by `motor` [of travel] from the reading 0.
double axis_travel(const DriveError& error, double lead, double motor);
/// Its inverse, to 1e-12 of a lead.
double motor_travel(const DriveError& error, double lead, double axis);

}  // namespace understudy::sim
