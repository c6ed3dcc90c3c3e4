// The shell of a stretch, or of a part of it, with normals.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/surface/bead_sweep.h"

namespace understudy::sim {

/// Triangles with what each vertex knows besides its place.
struct SweptShell {
  BeadMesh mesh;
  std::vector<Vec3> normals;          ///< unit, outward: of what the faces stand for, not theirs
  std::vector<std::size_t> sections;  ///< which section of the stretch
};

/// Sections of a stretch from `first` to `last`, both included.
struct SectionRange {
  std::size_t first = 0, last = 0;
};

/// Appends the shell between two sections of a stretch of two or more, wound counter-clockwise from outside
/// and closed: rounded where the stretch ends, flat where it goes on. Flat ends that meet are equal, so that
/// the volumes of all parts add up to that of the whole. `sides` as in append_shell(); InputError beyond
/// 2^31 - 1 vertices.
void append_swept(const BeadStretch& stretch, const SectionRange& range, int sides, SweptShell& shell);

/// A blob, or one bead from end to end: append_shell() closes its ends without a ring.
bool is_one_bead(const BeadStretch& stretch);
/// That bead.
Bead one_bead(const BeadStretch& stretch);

/// What append_sweep() appends, with normals.
void append_whole(const BeadStretch& stretch, int sides, SweptShell& shell);

}  // namespace understudy::sim
