// The kinematics of a machine for other programs.
#pragma once

#include <span>
#include <string>

#include "machine/file/urdf_chain.h"

namespace understudy::machine {

/// A URDF with the root link "frame" at O, one link per axis, and the links "work" (S) and "tool" (T) at the
/// ends: read_urdf(file, "work", "tool") gives the same poses. Joints have the axes' names. Links hang at
/// their axis' point, along the axes of O. `links` of one axis become one body; `drives` may be empty. URDF
/// has no slide without end and no range open on one side: these end at 1e6, as do unknown speeds and
/// efforts.
std::string write_urdf(const std::string& name, const kinematics::Chain& chain,
                       std::span<const LinkMass> links = {}, std::span<const AxisDrive> drives = {});

}  // namespace understudy::machine
