// Triangle meshes: reading and checking STL, nearest points, ray hits, smooth normals and curvature.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/frames.h"

namespace understudy::geometry {

/// A point of the surface with its smooth outward normal (vertex normals interpolated over the triangle).
struct SurfacePoint {
  Vec3 position;       ///< [m]
  Vec3 normal;         ///< unit
  int triangle = -1;
  double distance = 0; ///< [m], from the query point or along the ray
};

/// Immutable indexed triangle mesh, counter-clockwise outside. Coordinates [m].
class Mesh {
 public:
  /// Throws InputError when there is no triangle or a coordinate is not finite.
  Mesh(std::vector<Vec3> vertices, std::vector<std::array<int, 3>> triangles);
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  const std::vector<Vec3>& vertex_normals() const { return vertex_normals_; }
  Vec3 lower() const { return lower_; }
  Vec3 upper() const { return upper_; }
  /// Edges that do not belong to exactly two triangles; 0 for a closed surface.
  int open_edges() const { return open_edges_; }

  SurfacePoint nearest(const Vec3& p) const;
  /// First hit of the ray from `origin` along the unit vector `direction`, at most `reach` away.
  std::optional<SurfacePoint> ray_hit(const Vec3& origin, const Vec3& direction, double reach) const;
  /// Signed distance, negative inside; meaningful for closed meshes.
  double signed_distance(const Vec3& p) const;

 private:
  struct Tree;
  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Vec3> vertex_normals_;
  Vec3 lower_, upper_;
  int open_edges_ = 0;
  std::unique_ptr<Tree> tree_;
};

struct MeshCheck {
  bool allow_open = false;
  double smallest_size = 1e-3;  ///< [m], bounding-box diagonal; smaller smells of metres taken for mm
  double largest_size = 2.0;    ///< [m]; larger smells of micrometres or inches scaled twice
};

/// Reads an STL in millimetres (the unit of files), welds its vertices. Throws InputError naming file, value
/// and limit for a file that is missing, truncated, empty, not finite, open, or of the wrong unit by size.
std::shared_ptr<const Mesh> read_stl(const std::filesystem::path& path, const MeshCheck& check = {});

/// Binary STL in millimetres.
std::string write_stl(const Mesh& mesh, const std::string& title);

}  // namespace understudy::geometry
