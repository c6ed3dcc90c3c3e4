// The machine as it was really built: what the plant uses and the controller does not know.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "machine/description.h"

namespace understudy::sim {

struct AsBuilt {
  std::string source;  ///< "nominal", "sampled", "manufactured", or the file it was read from
  std::uint64_t seed = 0;
  // Hexapod.
  kinematics::HexapodGeometry hexapod;       ///< true 42 parameters and dev
  kinematics::PerStrut<double> nut_play{};   ///< [m], total free travel
  kinematics::PerStrut<double> ball_play{};  ///< [m]
  // Open chain.
  kinematics::Chain chain;             ///< true screws and tool mount; empty for a hexapod
  kinematics::AxisVector axis_play{};  ///< [m] or [rad], total free travel
  kinematics::AxisVector axis_zero{};  ///< [m] or [rad], true position where a drive reads 0
};

/// `set` is nominal (what the controller knows), sampled (that, off by the tolerances left after
/// calibration), manufactured (the drawing, off by those of manufacture), or an as-built file
/// (as_built_file.h), which alters the drawing. So calibrating a machine file changes neither a manufactured
/// twin nor a file's, only what the controller knows of them. Throws InputError for another word.
AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set, std::uint64_t seed);

}  // namespace understudy::sim
