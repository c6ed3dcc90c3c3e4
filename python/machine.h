// A machine as scripts hold it: the description, which is what a controller believes, and its kinematics.
#pragma once

#include <memory>
#include <string>

#include "machine/calibrated_parameters.h"
#include "machine/description.h"

namespace understudy::python {

struct Machine {
  explicit Machine(const std::string& name_or_path);
  Machine(machine::MachineDescription of, std::string named);

  std::string word;  ///< as --machine takes it
  machine::MachineDescription description;
  std::shared_ptr<const kinematics::Mechanism> mechanism;
};

}  // namespace understudy::python
