// The hexapod of models/, read once in a process.
#pragma once

#include "machine/description.h"

namespace understudy {

inline const machine::MachineDescription& hexapod() {
  static const machine::MachineDescription machine = machine::load_machine("hexapod");
  return machine;
}

}  // namespace understudy
