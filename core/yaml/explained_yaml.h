// A YAML file written out with one key a line, and what each key means beside it.
#pragma once

#include <functional>
#include <string>

#include "core/yaml/map_schema.h"

namespace understudy {

/// `text` again, of the same values in the same order: each key on a line of its own, with the phrase and the
/// unit that `schema` has for it, what `mark` says of its path ("axes.home_deg", indexes of lists left out),
/// and the comments of `text`. Throws InputError where `text` is no YAML map.
std::string explained_yaml(const std::string& text, const MapSchema& schema,
                           const std::function<std::string(const std::string& path)>& mark);

}  // namespace understudy
