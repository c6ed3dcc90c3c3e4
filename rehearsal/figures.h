// The figures of a record under their names in summary.json, so that files and expectations speak of the
// same.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// Counts keep every digit.
using FigureValue = std::variant<double, std::uint64_t, std::string, std::vector<std::string>,
                                 std::map<std::string, std::string>>;

struct Figure {
  std::string section;  ///< "gap"
  std::string name;     ///< "start_mm": its unit is its ending
  FigureValue value;
};

/// Section by section in the order of the contract; what is absent is left out.
std::vector<Figure> figures(const Record& record);
/// Section "timing"; empty where nothing was simulated. Not in the summary, which is the same for equal
/// inputs.
std::vector<Figure> timing_figures(const Record& record);

}  // namespace understudy::rehearsal
