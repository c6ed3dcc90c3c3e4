// The part as printed, as a file that other programs open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "geometry/mesh.h"
#include "sim/beads/bead_index.h"
#include "sim/surface/bead_sweep.h"

namespace understudy::sim {

struct AsPrintedSettings {
  int sides = kBeadSides;                    ///< see bead_mesh.h
  double tolerance = 5e-6;                   ///< [m], see bead_sweep.h
  const geometry::Mesh* intended = nullptr;  ///< in W, closed; null: no deviation is written
  double limit = 0.2e-3;                     ///< [m], at which the colour scale ends
  /// Beads that lie deeper than this below the intended surface are left out [m]; needs `intended`.
  std::optional<double> skin;
  int threads = 0;  ///< 0: as many as the machine has; the bytes do not depend on it
};

struct AsPrintedSize {
  std::size_t beads = 0, vertices = 0, triangles = 0;
};

/// Beads that follow each other are one closed shell (bead_sweep.h). Where they overlap, the shells run
/// through each other and vertices inside other beads are kept: the outside is that of the union.
/// Millimetres, in W; bounded memory for any number of beads. The file appears under `path` only when it is
/// whole. Throws InputError: nothing printed, too many triangles for the format, a limit, skin or number of
/// sides out of range; MachineError where it cannot be written.
///
/// PLY: little endian; with an intended part every vertex has `deviation_mm`, its signed distance from the
/// intended surface (negative inside), and as colour the deviation from -limit (blue) over 0 (white) to limit
/// (red), clamped beyond. A comment states the limit.
AsPrintedSize write_as_printed_stl(const std::filesystem::path& path, const BeadIndex& beads,
                                   const AsPrintedSettings& settings = {});
AsPrintedSize write_as_printed_ply(const std::filesystem::path& path, const BeadIndex& beads,
                                   const AsPrintedSettings& settings = {});
/// By the ending of the name, .stl or .ply.
AsPrintedSize write_as_printed(const std::filesystem::path& path, const BeadIndex& beads,
                               const AsPrintedSettings& settings = {});

/// Red, green, blue. [m]
std::array<std::uint8_t, 3> deviation_colour(double deviation, double limit);

}  // namespace understudy::sim
