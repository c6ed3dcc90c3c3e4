// Private to this room: a picture's light, from an even sky and one lamp.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "renderer/gl_context.h"
#include "renderer/scene_drawing.h"

namespace understudy::renderer {

/// Directions towards the lights, in W, and clip coordinates of their shadow maps.
struct Lights {
  std::vector<Eigen::Vector3f> directions;  ///< of the sky
  std::vector<Eigen::Matrix4f> clips;
  Vec3 lamp{0, 0, 1};
  Eigen::Matrix4f lamp_clip;
  double radius = 0;  ///< [m], of the ball that they shine on
};

/// `radius` [m] is that of a ball that holds all that casts shadows.
Lights make_lights(const PictureScene& scene, double radius);

/// Shadow maps: depth textures as the lights see the scene.
struct ShadowMaps {
  explicit ShadowMaps(const GlFunctions& gl);
  /// `casters`: those of the solids' triangles that hide the sky.
  void draw(const GlFunctions& gl, const Lights& lights, const GlSurface& solids,
            const GlTriangles& casters) const;

  GlTarget sky, lamp;  ///< one map a light of the sky, side by side; the lamp's
};

/// What light.frag says of each pixel of `target`, which is half as wide and high as the picture.
void draw_light(const GlFunctions& gl, const Drawing& drawing, const Lights& lights, const ShadowMaps& maps,
                const GlTarget& target);

}  // namespace understudy::renderer
