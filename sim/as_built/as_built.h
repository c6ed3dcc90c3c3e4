// The machine as it was really built: what the plant uses and the controller does not know.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "machine/description.h"

namespace understudy::sim {

struct AsBuilt {
  std::string source;                       ///< "nominal", "sampled", "manufactured"
  std::uint64_t seed = 0;
  kinematics::HexapodGeometry hexapod;      ///< true 42 parameters and dev
  std::array<double, kinematics::kStruts> nut_play{};    ///< [m], total free travel
  std::array<double, kinematics::kStruts> ball_play{};   ///< [m]
};

/// `set` is nominal, sampled (tolerances left after calibration) or manufactured. Throws InputError for
/// another word.
AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set, std::uint64_t seed);

}  // namespace understudy::sim
