// The machines that Bullet plays. Private to this room.
#pragma once

#include <memory>

#include "sim/plant/plant.h"

namespace understudy::sim {

std::unique_ptr<Plant> make_bullet_hexapod(const machine::MachineDescription& machine,
                                           const AsBuilt& as_built, const BulletOptions& options);
/// The work stands on the frame: work_axis == -1.
std::unique_ptr<Plant> make_bullet_chain(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const BulletOptions& options);

}  // namespace understudy::sim
