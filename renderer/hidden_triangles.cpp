#include "renderer/hidden_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace understudy::renderer {
namespace {

// A hundred roundings of a float next to 1: the rasteriser interpolates what is projected here.
constexpr float kRounding = 6e-6f;
constexpr float kPixelsMost = 4096;  // that a triangle is looked for in; a larger one is drawn without a look

/// Of a triangle in the picture: columns, rows and the least depth.
struct Extent {
  float left = HUGE_VALF, right = -HUGE_VALF, bottom = HUGE_VALF, top = -HUGE_VALF, nearest = HUGE_VALF;
};

/// A vertex in the picture: column, row, depth.
struct Projected {
  float x = 0, y = 0, depth = 0;
  bool is_before_eye = false;
};

std::vector<Projected> project(const std::vector<float>& vertices, const Eigen::Matrix4f& clip,
                               const FarthestSeen& seen) {
  std::vector<Projected> projected;
  projected.reserve(vertices.size() / kVertexFloats);
  for (std::size_t i = 0; i + kVertexFloats <= vertices.size(); i += kVertexFloats) {
    const float* p = &vertices[i];
    const Eigen::Vector4f at = clip * Eigen::Vector4f(p[0], p[1], p[2], 1);
    projected.push_back({0.5f * (at.x() / at.w() + 1) * static_cast<float>(seen.width),
                         0.5f * (at.y() / at.w() + 1) * static_cast<float>(seen.height),
                         0.5f * (at.z() / at.w() + 1), at.w() > 0 && at.z() >= -at.w()});
  }
  return projected;
}

/// Nothing where a corner is not before the eye.
std::optional<Extent> extent_of(const std::vector<Projected>& vertices, const std::uint32_t* corners) {
  Extent extent;
  for (std::size_t k = 0; k < 3; ++k) {
    const Projected& at = vertices[corners[k]];
    if (!at.is_before_eye) return std::nullopt;
    extent.left = std::min(extent.left, at.x);
    extent.right = std::max(extent.right, at.x);
    extent.bottom = std::min(extent.bottom, at.y);
    extent.top = std::max(extent.top, at.y);
    extent.nearest = std::min(extent.nearest, at.depth);
  }
  return extent;
}

/// Pixels from the first to the last that lie within [from, to] or touch it, of `count`.
std::array<int, 2> pixels(float from, float to, int count) {
  const auto most = static_cast<float>(count - 1);
  return {static_cast<int>(std::max(0.0f, std::floor(from) - 1)),
          static_cast<int>(std::min(most, std::floor(to) + 1))};
}

bool is_hidden(const Extent& extent, const FarthestSeen& seen) {
  const auto [first_column, last_column] = pixels(extent.left, extent.right, seen.width);
  const auto [first_row, last_row] = pixels(extent.bottom, extent.top, seen.height);
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(seen.width) +
                             static_cast<std::size_t>(column);
      if (extent.nearest <= seen.depth[at] + kRounding) return false;
    }
  return true;
}

}  // namespace

std::vector<std::uint32_t> without_backs(const PictureTriangles& triangles, const CornerRange& closed,
                                         const Eigen::Vector4f& from) {
  const auto place = [&](std::size_t corner) {
    return Eigen::Vector3f::Map(&triangles.vertices[kVertexFloats * triangles.corners[corner]]);
  };
  const auto turns_away = [&](std::size_t i) {
    const Eigen::Vector3f a = place(i), normal = (place(i + 1) - a).cross(place(i + 2) - a);
    return normal.dot(from.head<3>() - from.w() * a) < 0;
  };
  std::vector<std::uint32_t> kept;
  kept.reserve(triangles.corners.size());
  for (std::size_t i = 0; i + 3 <= triangles.corners.size(); i += 3) {
    if (i >= closed.begin && i < closed.end && turns_away(i)) continue;
    kept.insert(kept.end(), &triangles.corners[i], &triangles.corners[i] + 3);
  }
  return kept;
}

std::vector<std::uint32_t> without_hidden(const PictureTriangles& triangles, const Eigen::Matrix4f& clip,
                                          const FarthestSeen& seen) {
  const Extent picture{0, static_cast<float>(seen.width), 0, static_cast<float>(seen.height), 0};
  const auto inside = [&](const Extent& extent) {
    return Extent{std::max(extent.left, picture.left), std::min(extent.right, picture.right),
                  std::max(extent.bottom, picture.bottom), std::min(extent.top, picture.top), extent.nearest};
  };
  const std::vector<Projected> vertices = project(triangles.vertices, clip, seen);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i + 3 <= triangles.corners.size(); i += 3) {
    const std::uint32_t* corners = &triangles.corners[i];
    if (const auto extent = extent_of(vertices, corners)) {
      const Extent in = inside(*extent);
      const float area = std::max(0.0f, in.right - in.left) * std::max(0.0f, in.top - in.bottom);
      if (area <= kPixelsMost && is_hidden(in, seen)) continue;
    }
    kept.insert(kept.end(), corners, corners + 3);
  }
  return kept;
}

}  // namespace understudy::renderer
