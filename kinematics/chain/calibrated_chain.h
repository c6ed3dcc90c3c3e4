// A chain whose axes were measured: no closed form fits it, but that of the drawn chain is near.
#pragma once

#include <memory>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

/// `description.chain` is the measured chain, `description.design` the drawn one with the same axes.
/// inverse() starts from the drawn chain's solution, so it has its branches, and ends where the measured
/// chain is at the pose. Without rotary words.
std::unique_ptr<Mechanism> make_calibrated_chain(const ChainDescription& description);

}  // namespace understudy::kinematics
