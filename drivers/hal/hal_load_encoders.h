// Private to drivers/hal: what a configuration has of encoders behind the play (docs/linuxcnc.md). Nothing
// where the machine has none.
#pragma once

#include <string>

#include "drivers/hal/hal_settings.h"

namespace understudy::drivers {

/// Parts of machine.hal: what is loaded, in which order it runs, and how each position comes to a column of
/// the sampler that the port reads; `first_column`: that of axis 0.
std::string load_encoder_components(const HalSettings& settings);
std::string load_encoder_functions(const HalSettings& settings);
std::string load_encoder_nets(const HalSettings& settings, std::size_t first_column);
/// Of pins.hal: an encoder of each axis that reads what the drive does.
std::string simulated_load_encoders(const HalSettings& settings);
/// Of the README: rows of the table of signals.
std::string load_encoder_signals(const HalSettings& settings);

}  // namespace understudy::drivers
