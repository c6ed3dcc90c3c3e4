// The files of a HAL configuration, as `halrun -I -f machine.hal` loads them in their folder.
#pragma once

#include <string>
#include <vector>

#include "drivers/hal/hal_settings.h"

namespace understudy::drivers {

struct HalFile {
  std::string name;
  std::string text;
};

/// machine.hal: what is the same on every machine of this description. steps.hal: step generators in
/// software. pins.hal: switches, heater, fan and probe; simulated. README.md: what a real machine changes.
std::vector<HalFile> hal_files(const HalSettings& settings);

/// Types of the columns of a row that the port writes to `streamer` (axes, row number, reset, nozzle [deg C],
/// fan [0..1]), and of a sample that it reads back (feedback, row number, underruns, six bits, what
/// encoders behind the play read), as `cfg=` wants them.
std::string stream_columns(const HalSettings& settings);
std::string sample_columns(const HalSettings& settings);

}  // namespace understudy::drivers
