// The machine as it was really built: what the plant uses and the controller does not know.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "machine/description.h"

namespace understudy::sim {

struct AsBuilt {
  /// "nominal", "sampled", "manufactured", "calibrated", the file it was read from, or empty: as described.
  std::string source;
  std::uint64_t seed = 0;
  // Hexapod.
  kinematics::HexapodGeometry hexapod;       ///< true 42 parameters and dev
  kinematics::PerStrut<double> nut_play{};   ///< [m], total free travel
  kinematics::PerStrut<double> ball_play{};  ///< [m]
  // Open chain.
  kinematics::Chain chain;             ///< true screws and mounts; empty for a hexapod
  kinematics::AxisVector axis_play{};  ///< [m] or [rad], total free travel
  kinematics::AxisVector axis_zero{};  ///< [m] or [rad], true position where a drive reads 0
};

/// A machine that is exactly what its description says, calibrated geometry included: no truth about a
/// machine that stands somewhere, but what pictures and exports show.
AsBuilt as_described(const machine::MachineDescription& machine);

/// The machine that stands there, whatever its controller believes of it. `set` is nominal (the drawing),
/// sampled (the drawing, off by the tolerances that a calibration is expected to leave), manufactured (off by
/// those of manufacture) or an as-built file (as_built_file.h), which alters the drawing: calibrating a
/// machine file changes none of these. Or it is calibrated (calibrated_draw.h): what the calibration of this
/// file leaves open. Throws InputError for another word.
AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set, std::uint64_t seed);

/// What a print is tried on unless something else is asked for: calibrated where the file has a calibration,
/// else sampled.
std::string default_as_built(const machine::MachineDescription& machine);

}  // namespace understudy::sim
