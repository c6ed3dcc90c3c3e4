// STL in and out. assimp parses; whether a print may rely on the surface is decided here.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include "core/error.h"
#include "core/error_context.h"
#include "core/file/read_file.h"
#include "geometry/mesh.h"
#include "geometry/stl_structure.h"

namespace understudy::geometry {
namespace {

struct Soup {
  std::vector<Vec3> corners;  // three a triangle [m]
};

Soup parse_stl(const std::string& bytes, const std::string& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "stl");
  if (scene == nullptr)
    throw InputError(Place{file}, std::string("not an STL: ") + importer.GetErrorString());
  Soup soup;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& v = mesh.mVertices[face.mIndices[k]];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
          throw InputError(Place{file}, fmt::format("triangle {} has a corner at ({}, {}, {}) mm, not finite",
                                                    soup.corners.size() / 3 + 1, v.x, v.y, v.z));
        soup.corners.push_back(kMillimetre * Vec3(v.x, v.y, v.z));
      }
    }
  }
  return soup;
}

void check_size(const Soup& soup, const MeshCheck& check, const std::string& file) {
  Vec3 lower = soup.corners[0], upper = soup.corners[0];
  for (const Vec3& p : soup.corners) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const double across = (upper - lower).norm();
  if (across < check.smallest_size)
    throw InputError(
        Place{file},
        fmt::format(
            "{:.3g} mm across, smaller than {:.3g} mm: is it in metres? STL files are read as millimetres",
            to_mm(across), to_mm(check.smallest_size)));
  if (across > check.largest_size)
    throw InputError(Place{file}, fmt::format("{:.6g} mm across, larger than {:.6g} mm: is it in "
                                              "micrometres? STL files are read as millimetres",
                                              to_mm(across), to_mm(check.largest_size)));
}

// Corners closer than the rounding of the file's single-precision numbers become one vertex.
class Welder {
 public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {}

  int weld(const Vec3& p) {
    const Cell low = cell(p - Vec3::Constant(tolerance_)), high = cell(p + Vec3::Constant(tolerance_));
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          if (const int found = find({x, y, z}, p); found >= 0) return found;
    vertices_.push_back(p);
    const int vertex = static_cast<int>(vertices_.size()) - 1;
    cells_.emplace(cell(p), vertex);
    return vertex;
  }
  std::vector<Vec3>& vertices() { return vertices_; }
  double tolerance() const { return tolerance_; }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t i : c)
        h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29;
      return static_cast<std::size_t>(h);
    }
  };
  Cell cell(const Vec3& p) const {
    const Vec3 scaled = (p / (8 * tolerance_)).array().floor();
    return {static_cast<std::int64_t>(scaled.x()), static_cast<std::int64_t>(scaled.y()),
            static_cast<std::int64_t>(scaled.z())};
  }
  int find(const Cell& c, const Vec3& p) const {
    const auto [first, last] = cells_.equal_range(c);
    for (auto it = first; it != last; ++it)
      if ((vertices_[static_cast<std::size_t>(it->second)] - p).norm() <= tolerance_) return it->second;
    return -1;
  }

  double tolerance_;
  std::vector<Vec3> vertices_;
  std::unordered_multimap<Cell, int, Hash> cells_;
};

// A triangle lower than the corners' rounding has no normal, and no side that a print could lie on.
void check_area(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t triangle, double tolerance,
                const std::string& file) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double height = longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
  if (height > tolerance) return;
  throw InputError(
      Place{file},
      fmt::format("triangle {} at ({:.3f}, {:.3f}, {:.3f}) mm has no area: it is {:.3g} mm high, not more "
                  "than the corners' rounding of {:.3g} mm",
                  triangle, to_mm(a.x()), to_mm(a.y()), to_mm(a.z()), to_mm(height), to_mm(tolerance)));
}

std::shared_ptr<const Mesh> weld(const Soup& soup, const std::string& file) {
  double largest = 0;
  for (const Vec3& p : soup.corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  Welder welder(4 * std::ldexp(largest, -24));  // two roundings of each of two corners, 2^-24 each
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 0; i + 2 < soup.corners.size(); i += 3) {
    const std::array<int, 3> t = {welder.weld(soup.corners[i]), welder.weld(soup.corners[i + 1]),
                                  welder.weld(soup.corners[i + 2])};
    // As welded: a corner that was moved onto its neighbour may have taken the height.
    const auto corner = [&](std::size_t k) { return welder.vertices()[static_cast<std::size_t>(t[k])]; };
    check_area(corner(0), corner(1), corner(2), i / 3 + 1, welder.tolerance(), file);
    triangles.push_back(t);
  }
  return std::make_shared<Mesh>(std::move(welder.vertices()), std::move(triangles));
}

std::string first_open_edge(const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles().size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.neighbours()[t][k] < 0) {
        const Vec3 p = mesh.vertices()[static_cast<std::size_t>(mesh.triangles()[t][k])];
        return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", to_mm(p.x()), to_mm(p.y()), to_mm(p.z()));
      }
  return "an unknown place";
}

void check_surface(const Mesh& mesh, const MeshCheck& check, const std::string& file) {
  if (mesh.open_edges() > 0 && !check.allow_open)
    throw InputError(
        Place{file},
        fmt::format(
            "{} edges do not belong to exactly 2 triangles, the first at {}: the surface is not closed",
            mesh.open_edges(), first_open_edge(mesh)));
  if (mesh.flipped_edges() > 0)
    throw InputError(
        Place{file},
        fmt::format(
            "{} edges, and 0 are allowed, join triangles of opposite winding: inside and outside are mixed",
            mesh.flipped_edges()));
  if (mesh.open_edges() == 0 && mesh.volume() <= 0)
    throw InputError(Place{file}, fmt::format("the volume is {:.6g} mm^3, below 0: the surface is inside out",
                                              mesh.volume() * 1e9));
}

void append_float(std::string& bytes, double value) {
  const float f = static_cast<float>(value);
  char raw[4];
  std::memcpy(raw, &f, 4);
  bytes.append(raw, 4);
}

}  // namespace

std::shared_ptr<const Mesh> read_stl(const std::filesystem::path& path, const MeshCheck& check) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  check_stl_structure(bytes, file);
  const Soup soup = parse_stl(bytes, file);
  if (soup.corners.empty()) throw InputError(Place{file}, "0 triangles, at least 1 is needed");
  check_size(soup, check, file);
  const std::shared_ptr<const Mesh> mesh = in_context_of(file, [&] { return weld(soup, file); });
  check_surface(*mesh, check, file);
  return mesh;
}

std::string write_stl(const Mesh& mesh, const std::string& title) {
  std::string bytes = title.substr(0, 80);
  bytes.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(mesh.triangles().size());
  char raw[4];
  std::memcpy(raw, &count, 4);
  bytes.append(raw, 4);
  for (const auto& triangle : mesh.triangles()) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = 1e3 * mesh.vertices()[static_cast<std::size_t>(triangle[k])];
    const Vec3 n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (int i = 0; i < 3; ++i) append_float(bytes, n[i]);
    for (const Vec3& p : corners)
      for (int i = 0; i < 3; ++i) append_float(bytes, p[i]);
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace understudy::geometry
