// The object that a print is laid on: found, read, and placed where it can be.
#pragma once

#include <memory>
#include <string>

#include "geometry/mesh.h"
#include "machine/description.h"

namespace understudy::rehearsal {

/// Path of a fixture: a file, or NAME for models/parts/NAME.stl. Throws InputError naming the known ones.
std::string find_fixture(const std::string& fixture);

/// Reads it, coordinates in W. Throws InputError as read_stl does, and for an object that reaches into the
/// table or stands where the machine is at home.
std::shared_ptr<const geometry::Mesh> read_fixture(const std::string& path,
                                                   const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
