// By how much a built machine, its sensors and the part clamped on it differ from the machine file besides
// the geometry. A controller uses none of it, so it stands in the machine file and not in the description.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"

namespace understudy::machine {

/// 1 sigma each, independent of each other; 0: as described. Shares are of the described value.
struct BuiltTolerances {
  // Every drive that turns a screw.
  double lead = 0;      ///< share: a lead that is long or short
  double periodic = 0;  ///< [m], amplitude of an error with the period of one motor turn
  double play = 0;      ///< share, of each play
  // Laser and camera, besides their mounting, which a controller uses too (MountingTolerances).
  double laser_power = 0;    ///< share
  double waist = 0;          ///< share
  double blur = 0;           ///< share
  double ambient_light = 0;  ///< share
  double camera_centre = 0;  ///< [px], each coordinate of the principal point
  double distortion = 0;     ///< of the lens, k1
  // The clamped part.
  double part_position = 0;  ///< [m], each coordinate
  double part_rotation = 0;  ///< [rad], about each axis of W
  double part_size = 0;      ///< share
  double part_ripple = 0;    ///< [m], amplitude of waves of its surface
  // The table.
  double table_height = 0;    ///< [m]
  double table_tilt = 0;      ///< [rad], about x and y of W
  double table_flatness = 0;  ///< [m], between its middle and its rim
  // Filament and light.
  double filament_diameter = 0;   ///< [m]
  double extruder_lag = 0;        ///< share
  double nozzle_temperature = 0;  ///< [K], what the sensor misses
};

/// The optional maps `drives`, `optics`, `part` and `process` of the section `tolerances`.
void read_built_tolerances(YamlMap& map, BuiltTolerances& tolerances);

/// The keys of `part`, which a fixture file has as well. Those that are left out leave `tolerances` as it is.
void read_part_tolerances(YamlMap& map, BuiltTolerances& tolerances);

/// Of a machine file or a name, as load_machine() finds it; throws InputError as that does.
BuiltTolerances load_built_tolerances(const std::string& name_or_path);

}  // namespace understudy::machine
