// Cross-sections of what a nozzle lays.
#pragma once

namespace understudy::toolpath {

/// Cross-section of a flattened strand, a rectangle with rounded ends: (width - height) height + pi height^2
/// / 4 [m^2]. Needs width >= height.
double bead_area(double width, double height);

/// Cross-section of a round strand or filament [m^2].
double strand_area(double diameter);

}  // namespace understudy::toolpath
