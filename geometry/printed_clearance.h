// When a tool touches printed material: one rule for the collision check of a rehearsal and for planners.
#pragma once

#include <string_view>

namespace understudy::geometry {

/// The nozzle works at the material; every other body of a tool keeps away from it.
inline bool is_nozzle(std::string_view body) { return body.starts_with("nozzle"); }

/// [m]: how deep the nozzle may press into printed material that it passes over, half a usual layer.
constexpr double kNozzlePress = 0.1e-3;

/// [m]: a body whose clearance to printed material is at or below this touches it.
constexpr double contact_with_printed(bool nozzle, double press = kNozzlePress) {
  return nozzle ? -press : 0.0;
}

/// [m] of the tip's path: what was laid within it is still under the nozzle, and no obstacle to it.
constexpr double fresh_path(double nozzle_flat, double bead_width) { return nozzle_flat + 2 * bead_width; }

}  // namespace understudy::geometry
