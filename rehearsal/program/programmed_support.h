// Whether the program lays a stretch of bead on something, whatever lies there in truth.
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/program/programmed_layers.h"
#include "sim/deposition/deposition.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// What a program means, and where.
struct ProgrammedPrint {
  const toolpath::Program& program;
  const ProgrammedLayers& layers;  ///< of it
  const machine::MachineDescription& machine;
  std::shared_ptr<const geometry::Mesh> part;  ///< as drawn; may be null
};

/// [m], for each stretch: the longest piece of its path, with the bare path before it, that the program lays
/// on part, table or what it printed before: from half of its line's layer to the stretch's `highest_gap`
/// above it. Each place of the stretch stands for the nearest one on the lines on which it was laid.
std::vector<double> programmed_support(const ProgrammedPrint& print,
                                       const std::vector<sim::UnsupportedStretch>& stretches);

/// An error for each stretch that passes for a bridge or for one over a groove, because its ends are held,
/// and that the program lays on something: over more of its path, with the bare one before it, than two
/// bores, one from what is there before and one from what comes after.
std::vector<Finding> support_findings(const ProgrammedPrint& print,
                                      const std::vector<sim::UnsupportedStretch>& loose);

}  // namespace understudy::rehearsal
