// The port that a URI names: what `understudy drive` prints on (docs/drive.md).
#pragma once

#include <memory>
#include <string>

#include "machine/description.h"
#include "machine/port.h"

namespace understudy::drivers {

/// By scheme: loopback://, serial://, tcp://, hal://. The description must outlive the port. Throws
/// InputError for a URI that no driver understands, naming what is wrong in it, and MachineError for a
/// machine that does not answer.
std::unique_ptr<machine::MachinePort> open_port(const std::string& uri,
                                                const machine::MachineDescription& machine);

}  // namespace understudy::drivers
