#pragma once

#include <string>

#include "machine/description.h"

namespace understudy::cli {

/// Throws InputError for a hexapod, whose struts close loops.
std::string urdf_of(const machine::MachineDescription& machine);

/// The URDF that the machine's file names, with calibrated origins; of another machine as urdf_of().
std::string calibrated_urdf_of(const machine::MachineDescription& machine);

}  // namespace understudy::cli
