// The section `rods` of a machine whose tool hangs on rods (kinematics/chain/rods.h).
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

/// After geometry was read; asks for nothing where the machine has no rods.
void read_rods(YamlMap& root, ChainModel& model);

/// Throws InputError for rods that do not meet with the axes at home.
void check_rods(const YamlMap& root, const ChainModel& model);

}  // namespace understudy::machine
