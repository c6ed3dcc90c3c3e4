// The object that a print is laid on: read, and placed where it can be.
#pragma once

#include <memory>
#include <string>

#include "geometry/mesh.h"
#include "machine/description.h"

namespace understudy::rehearsal {

/// Reads it, coordinates in W. Throws InputError as read_stl does, and for an object that reaches into the
/// table or stands where the machine is at home.
std::shared_ptr<const geometry::Mesh> read_fixture(const std::string& path,
                                                   const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal
