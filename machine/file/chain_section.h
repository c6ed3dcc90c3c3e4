// The part of machine.yaml about open chains: geometry by the kind's parameters, and a list of axes, each
// with its range, drive, play and the body that it carries.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/description.h"
#include "machine/machine_notes.h"

namespace understudy::machine {

/// Fills chain, drives, X_WB, the home pose, and what a URDF leaves open. Throws InputError naming key, value
/// and limit for what cannot be built: contradictory ranges, home outside them, axes that coincide, an
/// unknown parent.
void read_chain(YamlMap& root, MachineDescription& machine, MachineNotes& notes);

}  // namespace understudy::machine
