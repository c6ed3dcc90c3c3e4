// The parts of machine.yaml about what moves and what it weighs: drives, play, masses, the tool's bodies.
#pragma once

#include "machine/description.h"
#include "machine/yaml_reader.h"

namespace understudy::machine {

void read_drive(YamlMap& map, Drive& drive);
void read_play(YamlMap& map, Play& play);
void read_masses(YamlMap& map, Masses& masses);
void read_tool(YamlMap& map, Tool& tool);

}  // namespace understudy::machine
