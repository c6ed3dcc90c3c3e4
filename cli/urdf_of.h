#pragma once

#include <string>

#include "machine/description.h"

namespace understudy::cli {

/// Throws InputError for a hexapod, whose struts close loops.
std::string urdf_of(const machine::MachineDescription& machine);

}  // namespace understudy::cli
