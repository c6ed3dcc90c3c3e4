// Consecutive beads as one swept body: for pictures, replays and files of large prints.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/frames.h"
#include "sim/beads/bead_index.h"
#include "sim/surface/bead_mesh.h"

namespace understudy::sim {

/// A stadium-shaped section of what was laid, as Bead states it.
struct BeadSection {
  Vec3 middle_W{0, 0, 0};  ///< [m]
  Vec3 up_W{0, 0, 1};      ///< unit, the tool axis when it was laid
  double width = 0;        ///< [m]
  double height = 0;       ///< [m]
  double laid_at = 0;      ///< [s]
  std::int32_t line = 0;   ///< of the G-code; the bead that ends here
};

/// Sections that change linearly from one to the next; the ends are rounded by half the height. One section
/// alone is a blob.
using BeadStretch = std::vector<BeadSection>;

/// At a share of the way from one to the next; `line` is that of the next.
BeadSection section_between(const BeadSection& a, const BeadSection& b, double share);

struct SweepSettings {
  double by = HUGE_VAL;  ///< [s], what is laid later is left out
  /// [m], by which the body's surface may be off that of the beads: their middle lines, half widths, half
  /// heights and mitred corners each by no more than this.
  double tolerance = 2e-6;
  double longest = HUGE_VAL;  ///< [m], of a piece that stands for several beads
  /// Which beads there are, one entry each; null: all. A stretch ends where one is missing.
  const std::vector<char>* chosen = nullptr;
};

/// What was laid, in order. Beads whose sections differ by more than the tolerance, that turn too sharply for
/// a mitre within it, or that do not touch begin a stretch of their own.
std::vector<BeadStretch> sweep_beads(const BeadIndex& beads, const SweepSettings& settings = {});

/// The same, one stretch at a time until `take` wants no more. Whether it took all of them.
bool sweep_beads(const BeadIndex& beads, const SweepSettings& settings,
                 const std::function<bool(BeadStretch)>& take);

/// Appends one closed shell, wound counter-clockwise from outside. `sides` as in append_shell().
void append_sweep(const BeadStretch& stretch, int sides, BeadMesh& mesh);
/// What append_sweep() adds.
ShellSize sweep_size(const BeadStretch& stretch, int sides);
/// The least number of sides whose faces lie no more than `error` [m] inside the sections' round parts, at
/// most 32.
int sides_within(const BeadStretch& stretch, double error);

}  // namespace understudy::sim
