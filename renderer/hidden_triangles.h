// Which triangles of a picture are seen: llvmpipe shades what lies behind, too, where a pixel has samples.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "renderer/scene_geometry.h"

namespace understudy::renderer {

/// Corners of the triangles, in order, without those of the closed surfaces that turn their inside to the
/// eye or the light: others of the same surface lie before them. `from` is homogeneous, in the vertices'
/// frame: a place with 1 or a direction towards it with 0.
std::vector<std::uint32_t> without_backs(const PictureTriangles& triangles, const CornerRange& closed,
                                         const Eigen::Vector4f& from);

/// What a pixel shows at its farthest sample, as depth buffers count: 0 near, 1 far. Bottom row first.
struct FarthestSeen {
  int width = 0, height = 0;  ///< [px]
  std::vector<float> depth;   ///< one a pixel
};

/// Corners of the triangles, in order, that may reach a sample of a pixel, where `clip` takes positions to
/// clip coordinates. Left out are only those that lie behind all samples of every pixel about them, or beside
/// the picture; a triangle that passes the eye stays.
std::vector<std::uint32_t> without_hidden(const PictureTriangles& triangles, const Eigen::Matrix4f& clip,
                                          const FarthestSeen& seen);

}  // namespace understudy::renderer
