// The part of an as-built file that is no geometry: drives, sensors, the clamped part, the filament.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// Keys that the file does not have leave `built` as it is; errors are those of read_as_built().
void read_world(YamlMap& root, AsBuilt& built);

/// Every value; of the drives those that have errors. Without the maps of what the machine does not have.
std::string write_world(const AsBuilt& built);

}  // namespace understudy::sim
