// What is clamped on the table: a shape, and how well it is known where it stands and how it was made
// (docs/machine-description.md#fixture-files).
#pragma once

#include <string>

#include "core/yaml/map_schema.h"
#include "machine/built_tolerances.h"

namespace understudy::machine {

/// Path of a fixture's shape, an STL: of a file, of a fixture file (.yaml), or of NAME for
/// models/parts/NAME.stl. Throws InputError naming the known ones, and for a fixture file that is none.
std::string find_fixture(const std::string& fixture);

/// The machine file's tolerances; where `fixture` is a fixture file, with those that it states in place of
/// the machine's of a part. Throws InputError as load_machine() and find_fixture() do.
BuiltTolerances load_built_tolerances(const std::string& machine, const std::string& fixture);

/// The fixture file itself where it is one, else empty.
std::string fixture_file_of(const std::string& fixture);

/// What a fixture file may hold.
MapSchema fixture_schema();

/// Reads a fixture file and its shape's path. Throws InputError with file, line, key and limit.
void check_fixture_file(const std::string& file);

}  // namespace understudy::machine
