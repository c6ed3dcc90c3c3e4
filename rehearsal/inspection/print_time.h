// How long a program takes on a machine, beside what its slicer says.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "machine/description.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// A limit that the slicer counted with, where the machine has another.
struct OtherLimit {
  std::string name;  ///< "acceleration"
  double slicer = 0, here = 0;
  std::string unit;
};

struct PrintTime {
  std::optional<double> planned;   ///< [s], of the motion planner; nothing where it cannot be planned
  std::optional<double> slicers;   ///< [s], of the comments
  std::vector<OtherLimit> limits;  ///< that may explain the difference
};

/// Of the program as the request reads it, up to `longest` steps; `facts` as of toolpath::slicer_facts().
/// Heating is in neither time.
PrintTime print_time(const RehearsalRequest& request, const std::map<std::string, std::string>& facts,
                     std::size_t longest = 500'000);

/// Limits of PrusaSlicer's and OrcaSlicer's machine settings that are more than 5 % off the machine's.
std::vector<OtherLimit> other_limits(const machine::MachineDescription& machine,
                                     const std::map<std::string, std::string>& facts);

}  // namespace understudy::rehearsal
