// What a picture is drawn from: triangles with colours, and the lights' directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/scene_view.h"

namespace understudy::renderer {

constexpr std::size_t kVertexFloats = 9;

/// Vertices of nine floats: position about `PictureGeometry::centre` in W's axes, normal, colour (see
/// scene.vert). A million triangles fit because those of one surface share their vertices.
struct PictureTriangles {
  std::vector<float> vertices;
  std::vector<std::uint32_t> corners;  ///< three vertices a triangle
};

/// Of PictureTriangles::corners, one after the other.
struct CornerRange {
  std::size_t begin = 0, end = 0;
};

struct PictureGeometry {
  Vec3 centre{0, 0, 0};                ///< in W [m]
  double radius = 0;                   ///< [m], of a sphere that holds everything but the ground
  double ground_fade = 0;              ///< [m]
  PictureTriangles solids;             ///< cast shadows
  CornerRange closed;                  ///< of the solids, what nobody sees the inside of
  std::vector<std::uint32_t> casters;  ///< of those, what hides the sky
  PictureTriangles ground;             ///< receives them
  PictureTriangles creases;            ///< thin, towards the eye
};

PictureGeometry picture_geometry(const PictureScene& scene);

/// Directions spread evenly over the upper half sphere.
std::vector<Vec3> sky_directions(int count);

}  // namespace understudy::renderer
