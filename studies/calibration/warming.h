// Private to the studies of calibration: screws of a hexapod that warm while it is measured.
#pragma once

#include "machine/description.h"

namespace understudy::studies {

constexpr double kScrewExpansion = 11.5e-6;  // [1/K], steel
constexpr double kSessionTimeConstants = 3;  // of the warming, in the time that a measurement takes

/// [m], by which a strut grows when it is `rise` [K] warmer: that of the middle of its range.
inline double strut_growth(const machine::MachineDescription& machine, double rise) {
  const auto& limits = machine.hexapod().limits;
  return kScrewExpansion * rise * 0.5 * (limits.strut_min + limits.strut_max);
}

}  // namespace understudy::studies
