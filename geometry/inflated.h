// A part made larger by the same depth everywhere, as stock for a finish that cuts that depth off.
#pragma once

#include <memory>

#include "geometry/mesh.h"

namespace understudy::geometry {

/// The mesh with every face moved outwards by `depth` [m] along its normal; edges and corners stay sharp
/// (mitred, by 4 depths at most). Faces at the bottom (their lower side on the mesh's lowest z) stay where
/// they are: the part stands there. Flat and convex faces are exact; where many faces meet, the corner is the
/// nearest in least squares. Throws InputError for a mesh that is not closed, a depth that is not above 0,
/// and where a face would turn round, because the part is hollow there and narrower than the depth: with the
/// place.
std::shared_ptr<const Mesh> inflated(const Mesh& mesh, double depth);

}  // namespace understudy::geometry
