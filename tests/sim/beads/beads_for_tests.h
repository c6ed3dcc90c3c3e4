// Beads and solids, made by hand and at random, and how to print them so that a failing case can be pasted.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/random.h"
#include "sim/beads/bead.h"
#include "sim/distance/convex_solid.h"

namespace understudy::sim::test {

Bead flat_bead(const Vec3& from, const Vec3& to, double width = 0.4e-3, double height = 0.2e-3);
Bead round_bead(const Vec3& from, const Vec3& to, double diameter);
Bead moved(const Bead& bead, const Pose& X);

Vec3 random_vector(Random& random, double size);  ///< in a cube of twice that size
/// Flat, round, blobs, a few much longer than a leaf, flat sides facing anywhere; starts in a cube of twice
/// `size`.
std::vector<Bead> random_beads(Random& random, int count, double size);
/// Of every kind, 0.05 to 3 mm.
geometry::Shape random_shape(Random& random);
ConvexSolid random_solid(Random& random);

/// C++ that makes it again.
std::string paste(const std::vector<Bead>& beads);
std::string paste(const geometry::Shape& shape);
std::string paste(const Pose& X);

/// Layers of zigzag lines, pieces of a length in [shortest, longest), 0.4 x 0.2 mm, `side` wide.
std::vector<Bead> zigzag(std::size_t count, double side, double shortest, double longest);

}  // namespace understudy::sim::test
