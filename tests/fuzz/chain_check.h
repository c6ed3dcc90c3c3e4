// An open chain as a URDF, written and read back.
#pragma once

#include <span>

#include "machine/file/urdf_chain.h"

namespace understudy::fuzz {

/// Throws Finding where the file of this chain does not read back as the same motion and masses.
void check_urdf_of(const kinematics::Chain& chain, std::span<const machine::LinkMass> links,
                   std::span<const machine::AxisDrive> drives);

}  // namespace understudy::fuzz
