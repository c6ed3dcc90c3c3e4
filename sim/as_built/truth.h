// The built machine in the form in which the twin's parts take it.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// `described`, which the controller holds, with the true optics, filament and extruder in their places. The
/// geometry stays in `built`.
machine::MachineDescription true_description(const machine::MachineDescription& described,
                                             const AsBuilt& built);

constexpr double kRippleLength = 20e-3;  // [m], of the waves of a built part, along (1, 1, 1) of W

/// The clamped part; `drawn` itself where nothing differs, null for null.
std::shared_ptr<const geometry::Mesh> true_part(std::shared_ptr<const geometry::Mesh> drawn,
                                                const BuiltPart& built);

}  // namespace understudy::sim
