// Beads as few pieces, for pictures of large prints.
#pragma once

#include <cmath>
#include <vector>

#include "sim/beads/bead.h"
#include "sim/beads/bead_index.h"

namespace understudy::report {

/// [m], by which the ends of joined beads may lie beside the piece that stands for them; and the share by
/// which their widths and heights may differ from its own.
constexpr double kJoinedOff = 5e-6, kJoinedShare = 0.05;

/// What was laid by a time [s]: beads that go on where the one before ended, nearly straight and alike, as
/// one.
std::vector<sim::Bead> joined_beads(const sim::BeadIndex& beads, double by = HUGE_VAL);

}  // namespace understudy::report
