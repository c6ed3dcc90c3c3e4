// Changed values put into a document. Private to this room.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "core/yaml/changed_file.h"

namespace understudy {

/// A key that is not there is added, with the sections above it: whoever reads the map refuses what it does
/// not know. Throws InputError, which begins with `file`, where the way to a value leads through another
/// value, past the end of a list, or to a name that no item has.
void change_values(YAML::Node& root, const ChangedFile& changed, const std::string& file);

}  // namespace understudy
