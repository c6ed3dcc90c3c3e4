// Shapes and meshes as triangles with normals per corner; both views draw from these.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/shape.h"

namespace understudy::renderer {

/// Normals belong to corners, so that a crease stays sharp and a curved face is shaded smoothly.
struct Surface {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;        ///< counter-clockwise outside
  std::vector<std::array<Vec3, 3>> corner_normals;  ///< unit
  std::vector<std::pair<Vec3, Vec3>> creases;       ///< edges worth a line in a picture
};

/// Looking for the creases of a mesh takes longer than all else.
enum class Creases { found, left_out };

/// In the frame F of the shape's owner. Round shapes get `segments` sides; a multiple of 4.
Surface tessellate(const geometry::Shape& shape, int segments, Creases creases = Creases::found);
/// With the mesh's own smooth normals; faces that meet at more than 30 degrees have a crease between them.
Surface tessellate(const geometry::Mesh& mesh, Creases creases = Creases::found);

void transform(Surface& surface, const Pose& X_AB);

}  // namespace understudy::renderer
