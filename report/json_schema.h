// What a reader of YAML asks for, as a JSON Schema (draft 07), which editors and validators understand.
#pragma once

#include <string>

#include "core/yaml/map_schema.h"

namespace understudy::report {

/// Every file that the reader accepts is valid. A file that is valid may still be refused: for values that do
/// not fit each other, and for what depends on something outside the file.
std::string json_schema(const MapSchema& schema, const std::string& title);

}  // namespace understudy::report
