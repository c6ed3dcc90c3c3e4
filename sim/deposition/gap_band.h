// Which gaps are good for a line: they follow its layer.
#pragma once

#include "machine/description.h"

namespace understudy::sim {

/// How deep the nozzle may press into printed material that it passes over: half a usual layer.
constexpr double kSoftDepth = 0.1e-3;  // [m]

struct GapBand {
  double low = 0;                  ///< [m]; what lies lower is pressed into its place, or touches
  double high = 0;                 ///< [m]; what lies higher does not stick
  double soft_depth = kSoftDepth;  ///< [m] into printed material
};

/// The band that the machine's description states, for layers about as high as its aim.
GapBand gap_band(const machine::GapLimits& limits);

/// The band of a line that its program means to lay `layer` [m] over what is below, with so much material
/// [m^2 of cross-section]. Layers within 15 % of the machine's aim have the machine's band. For others its
/// lower end is half of the layer, where the bead is twice as wide, but not below the machine's; for thinner
/// ones than the aim it keeps its proportion. Its upper end keeps its distance from the layer, as far as the
/// line is still pressed: to 0.95 diameters of the free strand. A line that is less than 1.4 times as wide as
/// high (docs/printing.md) is no line that the program could mean: it sticks up to the gap at which it has
/// that proportion.
GapBand gap_band(const machine::GapLimits& limits, double layer, double area);

}  // namespace understudy::sim
