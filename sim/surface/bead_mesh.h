// Beads as triangles: for the part as printed, for pictures and for what the laser sees.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/frames.h"
#include "sim/beads/bead.h"

namespace understudy::sim {

constexpr int kBeadSides = 8;  ///< of a full turn
constexpr int kBeadSidesMax = 256;

/// One closed shell a bead, wound counter-clockwise from outside; shells of neighbouring beads run through
/// each other. The vertices lie on the bead's surface, in W [m]. Vertices and triangles go to geometry::Mesh
/// as they are.
struct BeadMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Appends the shell of a bead that BeadIndex accepts. `sides` is a multiple of 4, from 4 to kBeadSidesMax;
/// InputError otherwise, and for a mesh beyond 2^31 - 1 vertices.
void append_shell(const Bead& bead, int sides, BeadMesh& mesh);
BeadMesh bead_mesh(std::span<const Bead> beads, int sides = kBeadSides);

/// How far the shell may lie inside the bead's surface [m].
double chord_error(const Bead& bead, int sides);

/// What append_shell() adds.
struct ShellSize {
  std::size_t vertices = 0, triangles = 0;
};
ShellSize shell_size(const Bead& bead, int sides);

}  // namespace understudy::sim
