// Section `gcode` of a machine file: the words of programs for this chain.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

/// The axes and their homes must have been read. Throws InputError with file, line and value for a letter or
/// an axis that is mapped twice, an axis that is not there, a letter that programs use otherwise, and words
/// that leave open how the tip is placed.
void read_gcode_section(YamlMap& root, MachineDescription& machine);

}  // namespace understudy::machine
