// How far off a print may be and still be good. A controller does not judge its own print, so this stands in
// the machine file and not in the description.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

/// The largest true errors while extruding.
struct AcceptedErrors {
  double tip = 0;          ///< [m], of the tip from where the program asks for it
  double orientation = 0;  ///< [rad], of the tool
};

/// Of a file that does not say: a bead that is off by a bore lies where the next one should, and a nozzle
/// that leans by more than 5 degrees puts its rim half into the smallest gap of 0.1 mm. A mill may be off by
/// 0.1 mm, a medium tolerance of ISO 2768 for what is up to 6 mm.
AcceptedErrors default_accepted_errors(const Tool& tool);

/// Section `accuracy`.
void read_accepted_errors(YamlMap& map, AcceptedErrors& errors);

/// As load_machine(); the defaults where the file has no section `accuracy`.
AcceptedErrors load_accepted_errors(const std::string& name_or_path);

}  // namespace understudy::machine
