// What a picture is drawn from: triangles with colours, and the lights' directions.
#pragma once

#include <vector>

#include "renderer/scene_view.h"

namespace understudy::renderer {

/// Vertices of nine floats: position about `centre` in W's axes, normal, colour (see scene.vert).
struct PictureGeometry {
  Vec3 centre{0, 0, 0};        ///< in W [m]
  double radius = 0;           ///< [m], of a sphere that holds everything but the ground
  double ground_fade = 0;      ///< [m]
  std::vector<float> solids;   ///< cast shadows
  std::vector<float> casters;  ///< what hides the sky, where that is not all of `solids`
  std::vector<float> ground;   ///< receives them
  std::vector<float> creases;  ///< thin, towards the eye
};

PictureGeometry picture_geometry(const PictureScene& scene);

/// Directions spread evenly over the upper half sphere.
std::vector<Vec3> sky_directions(int count);

}  // namespace understudy::renderer
