// Which strut lengths of a cubic lattice the nozzle leaves room for (Ishak 2018, figure 9).
#pragma once

#include <string>
#include <vector>

#include "toolpath/lattice/tool_envelope.h"

namespace understudy::toolpath {

struct StrutRange {
  double from = 0, to = 0;  ///< [m]
};

constexpr double kShortestLooked = 0.5e-3, kLongestLooked = 100e-3;  // [m]

/// The lengths, of those from 0.5 to 100 mm, with which the tool keeps `margin` [m] while a strut rises amid
/// a layer of such cubes: all around struts of `diameter` [m] stand as high already, as far apart as they are
/// long. Short struts stand too near to the nozzle, long ones reach what is above it. In ascending order, to
/// within 1 um.
std::vector<StrutRange> strut_ranges(const ToolEnvelope& tool, double diameter, double margin);

/// Whether the length is in one of them.
bool in_ranges(double length, const std::vector<StrutRange>& ranges);
/// "4.96..11.40 mm", rounded inwards; "0.91..3.70 or 4.96..11.40 mm"; "no length".
std::string to_string(const std::vector<StrutRange>& ranges);

}  // namespace understudy::toolpath
