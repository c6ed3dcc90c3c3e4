// Private to this folder: the text of a YAML file before its keys are read, and how messages name its nodes.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "core/error.h"

namespace understudy {

/// Throws InputError for a text that is too long, has control characters or more values than memory should
/// hold, and unless it is one document.
void check_yaml_text(const std::string& text, const std::string& file);

Place place_of(const YAML::Mark& mark, const std::string& file);
/// "a map", "a list", "empty", "'word'".
std::string kind_of(const YAML::Node& node);

}  // namespace understudy
