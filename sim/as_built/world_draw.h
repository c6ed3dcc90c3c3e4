// What differs from the machine file besides the geometry: drives, sensors, the clamped part, the filament.
#pragma once

#include "machine/built_tolerances.h"
#include "sim/as_built/as_built.h"
#include "sim/as_built/truth_seeds.h"

namespace understudy::sim {

/// Adds errors to `built`, whose source is set: each truth has a random stream of its own, named by source
/// and the seed of its group, so that one more changes no draw of another.
void draw_world(const machine::BuiltTolerances& tolerances, const TruthSeeds& seeds, AsBuilt& built);
/// Likewise, how laser and microscope sit about where `built` has them.
void draw_mounting(const machine::MountingTolerances& tolerances, const TruthSeeds& seeds, AsBuilt& built);

/// Moves each device in its own frame.
void move_mounting(const machine::MountingVector& error, AsBuilt& built);

}  // namespace understudy::sim
