// Private to this room: what the passes of a picture share.
#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "renderer/gl_context.h"
#include "renderer/scene_geometry.h"
#include "renderer/scene_view.h"

namespace understudy::renderer {

/// Rows: right, up and back of the eye, in W. Throws InputError where it looks nowhere or along up.
Mat3 eye_axes(const PictureScene& scene);

/// From positions about the scene's centre to clip coordinates.
Eigen::Matrix4f eye_clip(const PictureScene& scene, const PictureGeometry& geometry);

/// Vertices on the graphics side, and the triangles of them that are drawn.
struct GlSurface {
  GlSurface(const GlFunctions& gl, const PictureTriangles& from);
  void draw() const { vertices.draw(triangles); }

  GlVertices vertices;
  GlTriangles triangles;
};

/// What every pass draws.
struct Drawing {
  const PictureScene& scene;
  const PictureGeometry& geometry;
  const GlSurface &solids, &ground, &creases;
};

/// Every pixel of the bound target once, with the program in use.
void draw_all_pixels(const GlFunctions& gl);

}  // namespace understudy::renderer
