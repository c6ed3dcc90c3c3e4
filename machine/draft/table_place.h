// Where a table can stand before an arm.
#pragma once

#include <string>

#include "kinematics/chain/chain.h"

namespace understudy::machine {

struct TablePlace {
  bool found = false;
  Vec3 centre_B{0, 0, 0};         ///< [m], of the table's top
  kinematics::AxisVector home{};  ///< tool upright above it; the middle of the ranges where none was found
  double condition = 0;           ///< largest over the table
};

/// Of a square table of this half width [m]: the place where the tool stands upright over its middle, edges
/// and corners within all ranges, no joint below the table's top, at the least condition number. The same
/// place for the same chain.
TablePlace find_table_place(const kinematics::ChainDescription& description, double half);

}  // namespace understudy::machine
