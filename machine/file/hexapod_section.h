// The hexapod's part of machine.yaml: geometry of three-fold symmetry, and what struts and joints allow.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

/// geometry, limits, drive, play, masses.
void read_hexapod(YamlMap& root, MachineDescription& machine);

/// Throws InputError at `place` when joints coincide, a strut has no length or home breaks a limit. Fills the
/// stud axes, which are defined by the home pose.
void settle_home(const Place& place, MachineDescription& machine);

}  // namespace understudy::machine
