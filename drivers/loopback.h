// loopback://: a machine that does what it is told, at once; for dry runs.
#pragma once

#include <memory>

#include "drivers/port_uri.h"
#include "machine/description.h"
#include "machine/loopback_port.h"

namespace understudy::drivers {

/// Rests at home, in the ranges of the machine's axes, on the clock of a twin: 0.5 ms, or clock_ms. Throws
/// InputError for a place and for other options.
std::unique_ptr<machine::LoopbackPort> open_loopback(const PortUri& uri,
                                                     const machine::MachineDescription& machine);

}  // namespace understudy::drivers
