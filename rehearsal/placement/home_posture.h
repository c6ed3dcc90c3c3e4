// Where a chain stands at home: an arm reaches that pose in several postures, and goes on in the one it has.
#pragma once

#include <vector>

#include "machine/description.h"

namespace understudy::rehearsal {

/// `home` in mm and degrees, one an axis, takes the place of the machine file's; none: nothing changes.
/// Throws InputError for a hexapod, another number of axes and a value beyond its range.
void stand_at_home(const std::vector<double>& home, machine::MachineDescription& machine);

/// The other postures within the ranges that reach the machine's home pose, in mm and degrees; none for
/// machines that leave the tool's spin free.
std::vector<std::vector<double>> other_home_postures(const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
