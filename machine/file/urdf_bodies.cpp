#include "machine/file/urdf_bodies.h"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/outside.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/text/xml.h"
#include "geometry/convex_hull.h"

namespace understudy::machine {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kPackage = "package://", kFile = "file://";
constexpr std::size_t kSrdfBytesMax = 16'000'000;

/// The mesh of a link, in the frame of its shape.
geometry::Shape hull_of(const UrdfShape& shape, const UrdfMesh& mesh, const fs::path& path,
                        const fs::path& urdf) {
  std::vector<Vec3> points = geometry::read_mesh_points(path);
  for (Vec3& p : points) p = p.cwiseProduct(mesh.scale);
  const auto hull = geometry::convex_hull(
      points, fmt::format("{}: link '{}': mesh {}", urdf.string(), shape.link, path.string()));
  return {shape.link, geometry::MeshShape{hull}, shape.X_OS};
}

[[noreturn]] void missing(const UrdfShape& shape, const UrdfMesh& mesh, const MeshPlaces& places) {
  std::string at;
  for (const fs::path& place : mesh_places(mesh.file, places))
    at += (at.empty() ? "" : ", nor at ") + place.lexically_normal().string();
  throw InputError(
      {places.urdf.string(), 0, 0},
      fmt::format("link '{}': its collision mesh {} is not at {}: copy it there, name the folder of its "
                  "package in geometry.packages, or list the link in geometry.unchecked_links",
                  shape.link, printable(mesh.file), at));
}

geometry::Shape body_of(const UrdfShape& shape, const MeshPlaces& places, const fs::path& folder,
                        std::vector<fs::path>& files) {
  const auto* mesh = std::get_if<UrdfMesh>(&shape.form);
  if (!mesh) {
    geometry::Shape body{shape.link, geometry::Sphere{}, shape.X_OS};
    if (const auto* box = std::get_if<geometry::Box>(&shape.form)) body.form = *box;
    if (const auto* cylinder = std::get_if<geometry::Cylinder>(&shape.form)) body.form = *cylinder;
    if (const auto* sphere = std::get_if<geometry::Sphere>(&shape.form)) body.form = *sphere;
    return body;
  }
  const fs::path path = find_mesh(mesh->file, places);
  if (path.empty()) missing(shape, *mesh, places);
  if (!may_be_named_from(folder, path))
    throw InputError(
        {places.urdf.string(), 0, 0},
        fmt::format("link '{}': its collision mesh {} is outside the machine file's folder: copy it there, "
                    "or set {}=1 if you trust this file",
                    shape.link, path.string(), kAllowOutside));
  files.push_back(path);
  return hull_of(shape, *mesh, path, places.urdf);
}

}  // namespace

std::vector<fs::path> mesh_places(const std::string& named, const MeshPlaces& places) {
  const std::string_view name = named;
  if (name.starts_with(kFile)) return {fs::path(name.substr(kFile.size()))};
  const fs::path beside = fs::absolute(places.urdf).parent_path();
  if (!name.starts_with(kPackage)) return {beside / fs::path(name)};
  const fs::path path(name.substr(kPackage.size()));  // NAME/PATH
  fs::path within;
  for (auto part = path.begin(); part != path.end(); ++part)
    if (part != path.begin()) within /= *part;
  std::vector<fs::path> all{places.packages / path, places.packages / within};
  for (fs::path above = beside; above.has_relative_path(); above = above.parent_path())
    if (above.filename() == *path.begin()) all.push_back(above / within);
  return all;
}

fs::path find_mesh(const std::string& named, const MeshPlaces& places) {
  for (const fs::path& place : mesh_places(named, places)) {
    std::error_code error;
    if (fs::is_regular_file(place, error)) return place;
  }
  return {};
}

std::vector<UrdfBody> urdf_bodies(const UrdfArm& arm, const MeshPlaces& places, const fs::path& folder,
                                  const std::vector<std::string>& left_out, std::vector<fs::path>& files) {
  std::vector<UrdfBody> bodies;
  std::map<std::string, int> count;
  for (const UrdfShape& shape : arm.shapes) {
    if (std::find(left_out.begin(), left_out.end(), shape.link) != left_out.end()) continue;
    UrdfBody body{shape.link, shape.axis, body_of(shape, places, folder, files)};
    if (const int n = ++count[shape.link]; n > 1) body.shape.name += fmt::format(" {}", n);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

std::vector<std::array<std::string, 2>> read_srdf(const fs::path& path,
                                                  const std::vector<std::string>& links) {
  const std::string file = path.string(), text = read_file(path, kSrdfBytesMax);
  const auto fail = [&](const std::string& message) -> void { throw InputError({file, 0, 0}, message); };
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    fail(fmt::format("is no SRDF: {}", printable(document.ErrorStr())));
  const auto* root = document.RootElement();
  if (!root || std::string_view(root->Name()) != "robot") fail("is no SRDF: its root is not <robot>");
  std::vector<std::array<std::string, 2>> pairs;
  constexpr const char* kPair = "disable_collisions";
  for (const auto* e = root->FirstChildElement(kPair); e; e = e->NextSiblingElement(kPair)) {
    std::array<std::string, 2> pair;
    for (std::size_t k = 0; k < 2; ++k) {
      const char* key = k == 0 ? "link1" : "link2";
      const char* link = e->Attribute(key);
      if (!link) fail(fmt::format("line {}: {} has no {}", e->GetLineNum(), kPair, key));
      pair[k] = link;
      if (std::find(links.begin(), links.end(), pair[k]) != links.end()) continue;
      const std::string near = nearest_word(pair[k], links);
      fail(fmt::format("line {}: the URDF has no link '{}'{}", e->GetLineNum(), printable(pair[k]),
                       near.empty() ? "" : ", did you mean '" + near + "'?"));
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace understudy::machine
