// Whether a machine can follow the ways that a planner asks about.
#pragma once

#include "core/progress.h"
#include "machine/description.h"
#include "toolpath/lattice/lattice_sequence.h"
#include "toolpath/program.h"

namespace understudy::cli {

/// Every limit of a pose along the way, and no leap of an axis, as the motion planner asks for
/// (control/motion/path_kinematics.h); at the first pose the axes stand on the branch of the machine's home.
/// Looks at every 2 mm and 2 degrees, or at every 8 mm and 6 degrees where that is enough.
toolpath::WayCheck machine_reach(const machine::MachineDescription& machine);

/// Throws InputError for the first pose of the program that the machine cannot take, or cannot be led to:
/// with the place, the tilt there, the limit, and the tilt that it could take at this place.
void check_reach(const toolpath::Program& program, const machine::MachineDescription& machine,
                 const Progress& progress = {});

/// Throws InputError for the first pose that the machine does not reach when its axes are led from home
/// through the whole program: how a redundant axis stands depends on the way there. A singular pose is no
/// limit here: an end mill that stands upright on a table that turns is in one.
void check_reach_from_home(const toolpath::Program& program, const machine::MachineDescription& machine,
                           const Progress& progress = {});

}  // namespace understudy::cli
