// What differs from the machine file besides the geometry: drives, sensors, the clamped part, the filament.
#pragma once

#include "machine/built_tolerances.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// Adds errors to `built`, whose source and seed are set: each truth has a random stream of its own, named by
/// them, so that one more changes no draw of another.
void draw_world(const machine::BuiltTolerances& tolerances, AsBuilt& built);
/// Likewise, how laser and microscope sit about where `built` has them.
void draw_mounting(const machine::MountingTolerances& tolerances, AsBuilt& built);

/// Moves each device in its own frame.
void move_mounting(const machine::MountingVector& error, AsBuilt& built);

}  // namespace understudy::sim
