// How hot a start macro of the printer makes the nozzle, as far as the program tells.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace understudy::rehearsal {

/// [C], of a parameter of a command in words (START_PRINT EXTRUDER_TEMP=220), else of the slicer's comments,
/// of toolpath::slicer_facts(); nothing where neither tells.
std::optional<double> start_temperature(std::string_view text,
                                        const std::map<std::string, std::string>& facts);

}  // namespace understudy::rehearsal
