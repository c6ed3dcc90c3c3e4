// The parts of machine.yaml about what moves and what it weighs: drives, play, masses, the tool's bodies.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/cure.h"
#include "machine/description.h"

namespace understudy::machine {

/// `angle`: the axis turns; its keys are in degrees instead of mm.
void read_drive(YamlMap& map, bool angle, Drive& drive);
void read_play(YamlMap& map, Play& play);
void read_masses(YamlMap& map, Masses& masses);
/// Bodies of a tool or a link; poses in the frame that the file tells them in.
void read_bodies(YamlMap& map, std::vector<geometry::Shape>& bodies);
/// [kg m^2] along the axes of a frame; refuses moments that no body has.
Vec3 read_inertia(YamlMap& map, const std::string& key, const char* about);
void read_tool(YamlMap& map, Tool& tool, std::optional<Cure>& cure);
void read_process(YamlMap& map, Process& process);

}  // namespace understudy::machine
