// The section `geometry` of a machine file that names a URDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/yaml/yaml_map.h"
#include "machine/description.h"
#include "machine/machine_notes.h"

namespace understudy::machine {

/// Axes, links with their bodies, and the tool's mount `X_LT` on its link; the machine's checksum covers all
/// files that are read. A mesh is its convex hull. An axis that the URDF gives no mass has one of 0.
void read_urdf_chain(YamlMap& map, const Pose& X_LT, MachineDescription& machine, MachineNotes& notes);

/// Every file that a machine file of this text names or its URDF does: URDF, meshes that are checked, SRDF.
/// Empty for a machine without a URDF.
std::vector<std::filesystem::path> files_named_in(const std::string& text, const std::filesystem::path& file);

/// `geometry.tool_link` of a machine file of this text; empty for a machine without a URDF.
std::string tool_link_named_in(const std::string& text, const std::filesystem::path& file);

/// For such an axis: a round rod from it to the next one, or to the tool.
Link assumed_link(const kinematics::Chain& chain, int axis);

}  // namespace understudy::machine
