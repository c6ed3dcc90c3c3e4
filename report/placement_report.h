// The answer of `understudy place`: as text and as JSON (docs/placement.md).
#pragma once

#include <string>

#include "rehearsal/placement/placement.h"

namespace understudy::report {

/// For people, a line for each limit; `title` is "part.gcode on corexy".
std::string placement_text(const rehearsal::Placement& placement, const std::string& title);

struct PlacementProvenance {
  std::string program, machine, command;
};
std::string placement_json(const rehearsal::Placement& placement, const PlacementProvenance& provenance);

}  // namespace understudy::report
