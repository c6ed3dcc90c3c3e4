// Sections `planner` and `gap_control` of machine.yaml: what a user tunes of the controller.
#pragma once

#include "core/yaml/yaml_map.h"
#include "machine/control_settings.h"

namespace understudy::machine {

/// Both sections, and every key of them, may be left out; a default stays then. Throws InputError as YamlMap
/// does.
void read_control_section(YamlMap& root, ControlSettings& settings);

}  // namespace understudy::machine
