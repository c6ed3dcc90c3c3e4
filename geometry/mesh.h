// Triangle meshes: reading and checking STL, nearest points, ray hits, smooth normals and curvature.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/units.h"

namespace understudy::geometry {

/// A point of the surface with its smooth outward normal: vertex normals interpolated over the triangle, but
/// never across a crease.
struct SurfacePoint {
  Vec3 position;  ///< [m]
  Vec3 normal;    ///< unit
  int triangle = -1;
  double distance = 0;  ///< [m], from the query point or along the ray
};

/// Two faces that meet at more than this keep separate normals [rad].
constexpr double kCreaseAngle = 40 * kDegree;

/// Immutable indexed triangle mesh, counter-clockwise outside. Coordinates [m]. Every query is const, exact
/// to rounding and safe to call from many threads.
class Mesh {
 public:
  /// Triangles are neighbours when they share vertex indices; nothing is welded here. A vertex on a crease is
  /// duplicated, once for each smooth side, and the copies are appended behind the given vertices.
  /// Throws InputError when no triangle has an area, a coordinate is not finite, an index is out of range, or
  /// a triangle uses a vertex twice.
  Mesh(std::vector<Vec3> vertices, std::vector<std::array<int, 3>> triangles);
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  /// Unit, outward, averaged over the smooth side by corner angle and area (see normals.h).
  const std::vector<Vec3>& vertex_normals() const { return vertex_normals_; }
  /// The triangle across edge k (from corner k to corner k + 1); -1 where not exactly two triangles meet.
  const std::vector<std::array<int, 3>>& neighbours() const { return neighbours_; }
  Vec3 lower() const { return lower_; }
  Vec3 upper() const { return upper_; }
  /// Edges that do not belong to exactly two triangles; 0 for a closed surface.
  int open_edges() const { return open_edges_; }
  /// Edges whose two triangles wind against each other; 0 for a surface with one outside.
  int flipped_edges() const { return flipped_edges_; }
  /// [m^3], negative when a closed surface is inside out.
  double volume() const;

  SurfacePoint nearest(const Vec3& p) const;
  /// First hit of the ray from `origin` along the unit vector `direction`, at most `reach` away.
  std::optional<SurfacePoint> ray_hit(const Vec3& origin, const Vec3& direction, double reach) const;
  /// Signed distance, negative inside; meaningful for closed meshes. The sign is that of the angle-weighted
  /// pseudo-normal (Baerentzen and Aanaes 2005), right at edges and corners too.
  double signed_distance(const Vec3& p) const;

 private:
  struct Tree;
  static std::shared_ptr<const Tree> make_tree(const Mesh& mesh);
  /// Made when it is asked for first: what is only drawn needs none.
  const Tree& tree() const;
  SurfacePoint surface_point(int triangle, const Vec3& barycentric) const;

  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Vec3> vertex_normals_;
  std::vector<Vec3> pseudo_normals_;  ///< of vertices, over all faces around, across creases
  std::vector<std::array<int, 3>> neighbours_;
  Vec3 lower_, upper_;
  int open_edges_ = 0;
  int flipped_edges_ = 0;
  mutable std::once_flag tree_made_;
  mutable std::shared_ptr<const Tree> tree_;
};

struct MeshCheck {
  bool allow_open = false;
  double smallest_size = 1e-3;  ///< [m], bounding-box diagonal; smaller smells of a file in metres
  double largest_size = 2.0;    ///< [m]; larger smells of a file in micrometres
};

/// Reads an STL in millimetres (the unit of files), welds its vertices. Throws InputError naming file, value
/// and limit for a file that is missing, truncated, empty, not finite, open, inside out or wound both ways,
/// or of the wrong unit by size.
std::shared_ptr<const Mesh> read_stl(const std::filesystem::path& path, const MeshCheck& check = {});

/// Binary STL in millimetres.
std::string write_stl(const Mesh& mesh, const std::string& title);

}  // namespace understudy::geometry
