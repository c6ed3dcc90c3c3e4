// What a light guide cures of the resin in which it is held: the tool that accumulates (Song 2013, section
// 1).
//
// Sources: the cure depth of a scanned line, Jacobs 1992, Rapid Prototyping and Manufacturing, chapter 4; an
// even disc of light, as the end of a fibre has it, in place of his Gaussian spot.
#pragma once

#include <optional>
#include <string>

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

struct Cure {
  double guide_diameter = 0;     ///< [m], of the light where it leaves the guide
  double power = 0;              ///< [W], that leaves it
  double penetration_depth = 0;  ///< [m], over which the resin takes 63 % of the light
  double critical_exposure = 0;  ///< [J/m^2], from which it is solid

  /// [J/m^2], on the middle of a line that the guide draws at `speed` [m/s] above 0.
  double exposure(double speed) const;
  /// [m], of a line's middle below the guide; 0 where nothing becomes solid.
  double depth(double speed) const;
  /// [m], of a line where it leaves the guide; 0 where nothing becomes solid.
  double width(double speed) const;
  /// [m^2], of a line's section, no deeper than `gap` [m], the distance to what is below.
  double area(double speed, double gap) const;
};

/// The keys of a tool that cures, all but its bodies.
void read_cure(YamlMap& map, Tool& tool, std::optional<Cure>& cure);

/// As load_machine(); nothing for a tool that does not cure.
std::optional<Cure> load_cure(const std::string& name_or_path);

}  // namespace understudy::machine
