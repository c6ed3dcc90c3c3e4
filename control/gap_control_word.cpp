#include "control/gap_control_word.h"

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::control {

GapControl gap_control_of(const std::string& word, const machine::MachineDescription& machine) {
  if (word == "off" || (word.empty() && !machine.has_microscope)) return GapControl::off;
  if (word.empty() || word == "start" || word == "continuous") {
    if (machine.has_microscope) return word == "continuous" ? GapControl::continuous : GapControl::start;
    throw InputError(
        fmt::format("gap control '{}' needs a laser and a microscope; {} has none: off", word, machine.name));
  }
  throw InputError("gap control '" + word + "': one of off, start, continuous");
}

}  // namespace understudy::control
