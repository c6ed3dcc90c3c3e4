#include "geometry/inflated.h"

#include <Eigen/SVD>

#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "geometry/normals.h"

namespace understudy::geometry {
namespace {

constexpr double kLongestMitre = 4;  // depths
constexpr double kSameSide = 0.05;  // singular values below this share of the largest tell of one smooth side
constexpr double kFootLeans = 1e-6;  // a face of the foot: cosine against straight down
constexpr double kFootHigh = 1e-6;   // [m]

/// The faces that meet at one place.
struct Corner {
  Mat3 normal_matrix = Mat3::Zero();  // sum of n n^T
  Vec3 sum = Vec3::Zero();            // of n, but for those of the foot
};

/// The shortest m with n . m = 1 for all faces there (0 for the foot's), in least squares.
Vec3 way_out(const Corner& corner) {
  const Eigen::JacobiSVD<Mat3> svd(corner.normal_matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& s = svd.singularValues();
  Vec3 m = Vec3::Zero();
  // Singular values of n n^T are squares of those of the normals.
  for (int i = 0; i < 3; ++i)
    if (s[i] > kSameSide * kSameSide * s[0])
      m += svd.matrixV().col(i) * (svd.matrixU().col(i).dot(corner.sum) / s[i]);
  return m.norm() > kLongestMitre ? Vec3(kLongestMitre * m.normalized()) : m;
}

using Key = std::array<double, 3>;
Key key_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Vec3 normal_of(const std::vector<Vec3>& vertices, const std::array<int, 3>& t) {
  const auto at = [&](std::size_t k) { return vertices[static_cast<std::size_t>(t[k])]; };
  return face_normal(at(0), at(1), at(2));
}

/// Flat pieces that are cut into many triangles count once.
bool seen(std::vector<Vec3>& normals, const Vec3& n) {
  for (const Vec3& other : normals)
    if ((other - n).squaredNorm() < 1e-12) return true;
  normals.push_back(n);
  return false;
}

std::map<Key, Corner> corners_of(const Mesh& mesh) {
  std::map<Key, Corner> corners;
  std::map<Key, std::vector<Vec3>> counted;
  for (const auto& t : mesh.triangles()) {
    const Vec3 n = normal_of(mesh.vertices(), t);
    if (n.isZero()) continue;
    for (const int v : t) {
      const Vec3& p = mesh.vertices()[static_cast<std::size_t>(v)];
      if (seen(counted[key_of(p)], n)) continue;
      const bool foot = n.z() < -1 + kFootLeans && p.z() < mesh.lower().z() + kFootHigh;
      Corner& corner = corners[key_of(p)];
      corner.normal_matrix += n * n.transpose();
      if (!foot) corner.sum += n;
    }
  }
  return corners;
}

using Triangle = std::array<int, 3>;

/// A side that has turned round has passed through nothing: the faces beside it have met.
bool keeps_its_sides(const std::vector<Vec3>& before, const Triangle& t, const std::vector<Vec3>& after,
                     const Triangle& u) {
  const auto side = [](const std::vector<Vec3>& points, const Triangle& corners, std::size_t k) {
    return Vec3(points[static_cast<std::size_t>(corners[(k + 1) % 3])] -
                points[static_cast<std::size_t>(corners[k])]);
  };
  for (std::size_t k = 0; k < 3; ++k)
    if (side(before, t, k).dot(side(after, u, k)) <= 0) return false;
  return true;
}

}  // namespace

std::shared_ptr<const Mesh> inflated(const Mesh& mesh, double depth) {
  if (!(depth > 0) || !std::isfinite(depth))
    throw InputError(fmt::format("a depth of {:g} mm, it must be above 0", to_mm(depth)));
  if (mesh.open_edges() > 0)
    throw InputError(fmt::format("{} open edges: only a closed part has an outside", mesh.open_edges()));
  const std::map<Key, Corner> corners = corners_of(mesh);
  std::vector<Vec3> vertices;
  vertices.reserve(mesh.vertices().size());
  // The copies of a vertex on a crease stay together, and become one again.
  std::map<Key, int> number;
  std::vector<int> welded;
  for (const Vec3& p : mesh.vertices()) {
    const auto [entry, is_new] = number.try_emplace(key_of(p), static_cast<int>(vertices.size()));
    if (is_new) {
      const auto corner = corners.find(key_of(p));
      vertices.push_back(corner == corners.end() ? p : Vec3(p + depth * way_out(corner->second)));
    }
    welded.push_back(entry->second);
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : mesh.triangles()) {
    const auto at = [&](std::size_t k) { return welded[static_cast<std::size_t>(t[k])]; };
    triangles.push_back({at(0), at(1), at(2)});
    if (keeps_its_sides(mesh.vertices(), t, vertices, triangles.back())) continue;
    const Vec3& p = mesh.vertices()[static_cast<std::size_t>(t[0])];
    throw InputError(
        fmt::format("at ({:.2f}, {:.2f}, {:.2f}) mm the part is hollow, and too narrow to be {:g} mm larger",
                    to_mm(p.x()), to_mm(p.y()), to_mm(p.z()), to_mm(depth)));
  }
  return std::make_shared<Mesh>(std::move(vertices), std::move(triangles));
}

}  // namespace understudy::geometry
