// What stood where at one instant of a run: what pictures of it are drawn from.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/shape.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/configuration.h"
#include "sim/deposition/workpiece.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

struct Scene {
  bool simulated = false;               ///< false: the machine stands still
  double time = 0;                      ///< [s]
  Pose X_WT = Pose::Identity();         ///< true
  std::vector<geometry::Shape> bodies;  ///< of the machine, their poses in W
  geometry::Shape table;
  std::shared_ptr<const geometry::Mesh> part;     ///< may be null
  std::vector<std::vector<Vec3>> path;            ///< [m], programmed, what is still to be printed at `time`
  std::optional<Pose> X_WO;                       ///< of the machine's frame, where axes move the table
  std::shared_ptr<const sim::Workpiece> printed;  ///< null: nothing was simulated
};

/// The machine in a configuration, on its table; no part, no program.
Scene machine_scene(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                    const sim::Configuration& configuration);

/// Where the tip goes while it prints, one polyline [m] for each stretch between two travels; of the moves
/// behind a line of the program only, and of the first so many of them.
std::vector<std::vector<Vec3>> printed_path(const toolpath::Program& program, int after_line = 0,
                                            std::size_t moves_most = static_cast<std::size_t>(-1));

}  // namespace understudy::rehearsal
