// The files of a LinuxCNC configuration: its own planner and genhexkins, commanded through linuxcncrsh.
#pragma once

#include <vector>

#include "drivers/hal/hal_files.h"
#include "machine/description.h"

namespace understudy::drivers {

/// machine.ini, as `linuxcnc machine.ini` runs it; machine.hal: kinematics, feeder and what belongs to every
/// machine; pins.hal: drives, emergency stop, heater and fan, simulated; subroutines that the port calls, a
/// tool table, README.md. Throws InputError for a machine that is no hexapod.
std::vector<HalFile> linuxcnc_files(const machine::MachineDescription& machine,
                                    const HalOptions& options = {});

}  // namespace understudy::drivers
