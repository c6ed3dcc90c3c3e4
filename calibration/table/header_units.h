// Units that exports write into the headers of their columns: "X  [mm]", "A1 (deg)".
#pragma once

#include <string>

#include "calibration/table/column_map.h"

namespace understudy::calibration {

/// "X  [mm]" is the name "X" and the unit "mm". Brackets with anything else than a unit belong to the name:
/// "U(95)".
struct HeaderName {
  std::string name;  ///< one space between words
  std::string unit;  ///< "mm", "m", "um", "inch", "deg", "rad"; empty: none
};
HeaderName header_name(const std::string& header);

/// Settles the units of the map's numbers by the headers of their columns: of lengths, of orientations, of
/// joints. Throws InputError where they contradict the map or each other, and where neither tells a length.
void settle_units(const DelimitedText& text, const DelimitedText& joints, TableMap& map);

}  // namespace understudy::calibration
