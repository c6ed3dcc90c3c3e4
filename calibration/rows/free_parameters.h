// Which parameters of a machine mean anything, where the base is seen from nowhere or the tool by nothing.
#pragma once

#include <vector>

#include "calibration/rows/held_columns.h"

namespace understudy::calibration {

/// Columns of chain_rows() that whole poses all over the axes' ranges tell apart, in increasing order. With
/// `base_free` the frame of these poses is unknown; the base stays where it was: axis 0 as drawn, with the
/// azimuth and height of the next line (held_columns.h). With `tool_free` what was measured sits on the tool
/// at a place of its own, unknown as well, and the tool's mount is left at the drawing.
std::vector<Eigen::Index> free_parameters(const ChainParameters& nominal, bool base_free, bool tool_free,
                                          const StationaryAxes& stands = {});

/// The same of the 42 of a hexapod. With a free base the drawn place of base joint 1 and two directions from
/// it are kept, six numbers of base joints in all; with a free tool likewise of platform joints.
std::vector<Eigen::Index> free_parameters(const HexapodGeometry& nominal, bool base_free, bool tool_free);

}  // namespace understudy::calibration
