// Deposited material, as small as a million of them need it.
#pragma once

#include <array>
#include <cstdint>

namespace understudy::sim {

/// A straight stretch of deposited material as it lies: a stadium-shaped section (a rectangle with half-round
/// sides, `width` by `height`, or a circle where they are equal) swept from `from_W` to `to_W`, with the ends
/// rounded by half the height. Its flat side faces `up_W`, the tool axis when it was laid; the section's own
/// height direction is the part of `up_W` across the path. A stretch without length is a round blob.
struct Bead {
  std::array<float, 3> from_W{}, to_W{};  ///< [m], middle of the section at both ends
  std::array<float, 3> up_W{0, 0, 1};     ///< unit
  float width = 0, height = 0;            ///< [m], width >= height > 0
  float laid_at = 0;                      ///< [s], at its end
  std::int32_t line = 0;                  ///< of the G-code
};
static_assert(sizeof(Bead) == 52);

}  // namespace understudy::sim
