#include "geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <libqhull_r/libqhull_r.h>
#include <assimp/Importer.hpp>

#include "core/error.h"
#include "core/error_context.h"
#include "core/file/read_file.h"
#include "core/process/contained.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::geometry {
namespace {

constexpr std::size_t kBytesMax = 200'000'000;
constexpr int kNodesMax = 10'000;
constexpr std::size_t kPointsMax = 20'000'000;

/// assimp's importers crash, hang and grow on some files: they run in a process of their own.
ContainedLimits import_limits(std::size_t bytes) {
  return {2 + 1e-6 * static_cast<double>(bytes), 8'000'000'000, kPointsMax * sizeof(Vec3)};
}

/// Of the scene's tree of nodes, each with its meshes.
class PointReader {
 public:
  PointReader(const aiScene& scene, const std::string& file) : scene_(scene), file_(file) {}

  void add(const aiNode& node, const aiMatrix4x4& above) {
    if (++nodes_ > kNodesMax)
      throw InputError(Place{file_}, fmt::format("has more than {} nodes", kNodesMax));
    const aiMatrix4x4 here = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene_.mMeshes[node.mMeshes[m]], here);
    for (unsigned c = 0; c < node.mNumChildren; ++c) add(*node.mChildren[c], here);
  }
  std::vector<Vec3>& points() { return points_; }

 private:
  void add(const aiMesh& mesh, const aiMatrix4x4& X) {
    if (points_.size() + mesh.mNumVertices > kPointsMax)
      throw InputError(Place{file_}, fmt::format("has more than {} vertices", kPointsMax));
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D v = X * mesh.mVertices[i];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw InputError(Place{file_}, fmt::format("a vertex is at ({}, {}, {}), not finite", v.x, v.y, v.z));
      points_.emplace_back(v.x, v.y, v.z);
    }
  }

  const aiScene& scene_;
  const std::string& file_;
  std::vector<Vec3> points_;
  int nodes_ = 0;
};

bool less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

struct Hull {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
};

/// One run of qhull and its memory.
class Quickhull {
 public:
  explicit Quickhull(std::vector<double>& coordinates) {
    qh_zero(&qh_, silence_);
    char options[] = "qhull Qt";  // triangles, also where facets have more corners
    failed_ = qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(), False,
                           options, nullptr, silence_) != 0;
  }
  ~Quickhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(&qh_, &current, &total);
    std::fclose(silence_);
  }
  Quickhull(const Quickhull&) = delete;
  Quickhull& operator=(const Quickhull&) = delete;

  bool failed() const { return failed_; }
  Hull hull(const std::vector<Vec3>& points);

 private:
  std::FILE* silence_ = std::fopen("/dev/null", "w");
  qhT qh_{};
  bool failed_ = false;
};

Hull Quickhull::hull(const std::vector<Vec3>& points) {
  Hull hull;
  std::map<int, int> index;  // of a point among the vertices
  for (const facetT* facet = qh_.facet_list; facet && facet->next; facet = facet->next) {
    std::array<int, 3> t{};
    for (int k = 0; k < 3; ++k) {
      const auto* vertex = static_cast<const vertexT*>(facet->vertices->e[k].p);
      const int point = qh_pointid(&qh_, vertex->point);
      const auto [known, is_new] = index.emplace(point, static_cast<int>(hull.vertices.size()));
      if (is_new) hull.vertices.push_back(points[static_cast<std::size_t>(point)]);
      t[static_cast<std::size_t>(k)] = known->second;
    }
    const auto at = [&](std::size_t k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
    const Vec3 outward(facet->normal[0], facet->normal[1], facet->normal[2]);
    if ((at(1) - at(0)).cross(at(2) - at(0)).dot(outward) < 0) std::swap(t[1], t[2]);
    hull.triangles.push_back(t);
  }
  return hull;
}

std::vector<Vec3> imported_points(const std::string& bytes, const std::string& ending,
                                  const std::string& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // as robot viewers have it
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.c_str() + 1);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(Place{file}, std::string("is no mesh: ") + importer.GetErrorString());
  PointReader reader(*scene, file);
  reader.add(*scene->mRootNode, aiMatrix4x4());
  return std::move(reader.points());
}

std::vector<Vec3> contained_points(const std::string& bytes, const std::string& ending,
                                   const std::string& file) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto work = [&] {
    const std::vector<Vec3> points = imported_points(bytes, ending, file);
    return std::string(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Vec3));
  };
  const std::string made =
      in_context_of(file, [&] { return run_contained("reading it", work, import_limits(bytes.size())); });
  std::vector<Vec3> points(made.size() / sizeof(Vec3));
  if (!points.empty()) std::memcpy(points.front().data(), made.data(), points.size() * sizeof(Vec3));
  return points;
}

}  // namespace

std::vector<Vec3> read_mesh_points(const std::filesystem::path& path) {
  const std::string file = path.string(), bytes = read_file(path, kBytesMax);
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending != ".stl" && ending != ".dae" && ending != ".obj" && ending != ".ply")
    throw InputError(Place{file}, "is no mesh that is read: STL, COLLADA (.dae), OBJ and PLY are");
  if (ending == ".ply" && bytes.find("end_header") == std::string::npos)
    throw InputError(Place{file}, "is no PLY, or was cut off: its header has no end");
  std::vector<Vec3> points = contained_points(bytes, ending, file);
  if (points.size() < 3) throw InputError(Place{file}, "has 0 triangles, at least 1 is needed");
  return points;
}

std::shared_ptr<const Mesh> convex_hull(const std::vector<Vec3>& given, const std::string& what) {
  std::vector<Vec3> points = given;  // a mesh file has each vertex many times
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Vec3 lower = Vec3::Constant(INFINITY), upper = -lower;
  std::vector<double> coordinates;
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError(what + " holds a number that is not finite");
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
    coordinates.insert(coordinates.end(), p.data(), p.data() + 3);
  }
  const auto flat = [&] {
    throw InputError(points.empty() ? what + " has no points"
                                    : fmt::format("{} is flat: {:.3g} x {:.3g} x {:.3g} mm, no body", what,
                                                  to_mm(upper.x() - lower.x()), to_mm(upper.y() - lower.y()),
                                                  to_mm(upper.z() - lower.z())));
  };
  if (points.size() < 4) flat();
  Quickhull run(coordinates);
  if (run.failed()) flat();
  Hull hull = run.hull(points);
  try {
    auto mesh = std::make_shared<Mesh>(std::move(hull.vertices), std::move(hull.triangles));
    if (mesh->open_edges() > 0 || mesh->flipped_edges() > 0 || !(mesh->volume() > 0)) flat();
    return mesh;
  } catch (const InputError&) {
    flat();
  }
  return nullptr;
}

}  // namespace understudy::geometry
