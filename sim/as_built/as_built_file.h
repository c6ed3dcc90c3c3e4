// A built machine in a file: the parameters that differ from the description, as YAML.
#pragma once

#include <string>

#include "core/yaml/map_schema.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// Reads the values of the file into `built`, which holds the machine as drawn. Throws InputError with file,
/// line, key and limit; a name that is no file is answered with the words that are known.
void read_as_built(const std::string& file, AsBuilt& built);

/// The file, and what is changed of it, that the machine was read from; empty where it was drawn.
std::string file_of(const AsBuilt& built);

/// What such a file may hold, of any machine.
MapSchema as_built_schema();

/// The same file back: every parameter.
std::string write_as_built(const AsBuilt& built);

}  // namespace understudy::sim
