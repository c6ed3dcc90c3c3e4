// The MJCF of a hexapod: names that the plant looks up, and constants that both sides share.
#pragma once

#include <string>

#include "sim/plant/plant.h"

namespace understudy::sim {

/// Constraint impedance d at and beyond zero violation; 0.9999 is the hardest that MuJoCo takes.
constexpr double kImpedance = 0.9999;
/// Time constant of every constraint, in timesteps; MuJoCo is not stable below 2.
constexpr double kConstraintSteps = 2.0;

/// "strut 3 screw": joints, equalities and bodies are named after the strut that they belong to.
std::string strut_part(int strut, const char* part);

constexpr const char* kPlatformBody = "platform";
constexpr const char* kScrewPart = "screw";   ///< slide joint, and the equality that drives it
constexpr const char* kClosurePart = "ball";  ///< equality that closes the loop

}  // namespace understudy::sim
