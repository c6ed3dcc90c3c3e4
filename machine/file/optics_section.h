// The parts of machine.yaml about seeing the gap: laser and microscope, and whether they see the dot at all.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

void read_laser(YamlMap& map, Laser& laser);
void read_microscope(YamlMap& map, Microscope& microscope);

/// Throws InputError when the beam meets the nozzle's flat or the dot at the gap aimed at is out of view.
void check_optics(const YamlMap& root, const MachineDescription& machine);

}  // namespace understudy::machine
