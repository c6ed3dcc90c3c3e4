// Which parameters of a chain stay at the drawing, of those that stand in for each other.
#pragma once

#include <optional>
#include <vector>

#include "calibration/estimators/chain_calibration.h"

namespace understudy::calibration {

/// Readings [m] or [rad] of axes that never move; nothing of the others. Empty: all move.
using StationaryAxes = std::vector<std::optional<double>>;

/// A rigid motion of all that follows axis i, about axis i, is its zero; the lines of the axes behind it and
/// the tool can do the same. As in the tables of Denavit and Hartenberg, the next line that the motion moves
/// keeps its azimuth (or its shift, where it is parallel), so that a zero is told as a zero. With `base_free`
/// the base is axis 0 as drawn, with the azimuth and the height at which the next line stands; with
/// `tool_free` a motion that moves no line is one of the target, and the zero stays.
/// An axis that `stands` in all rows, if any is named, is a part of what carries it: none of its numbers is
/// told, and the first axis that moves is axis 0. Columns of chain_rows(), those of whole axes last.
std::vector<Eigen::Index> held_columns(const kinematics::Chain& chain, bool base_free, bool tool_free,
                                       const StationaryAxes& stands = {});

}  // namespace understudy::calibration
