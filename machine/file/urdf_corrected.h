// The URDF that a machine file names, with the calibrated places of its joints.
#pragma once

#include <filesystem>
#include <string>

#include "machine/description.h"

namespace understudy::machine {

/// The text of `urdf`, from which the machine's axes were drawn, with changed origins of joints and nothing
/// else: names, meshes, masses and limits stay. read_urdf() of it gives the lines and the zeros of the
/// machine's chain. Each link goes along with its axis, turned as little as that allows; what the calibration
/// says of the tool goes into the fixed joint above `tool_link`; where an axis moves that link itself, a link
/// `TOOL_LINK_calibrated` below it has the tool's place. Throws InputError for what read_urdf() refuses.
std::string corrected_urdf(const MachineDescription& machine, const std::filesystem::path& urdf,
                           const std::string& tool_link);

}  // namespace understudy::machine
