// Bytes as a mesh of an arm's link, whose hull is taken: PLY and COLLADA and text STL by their first words,
// else OBJ.
#include "geometry/convex_hull.h"
#include "geometry/mesh.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile ply("m.ply"), dae("m.dae"), stl("m.stl"), obj("m.obj");
  const std::string_view text = fuzz::text_of(data, size);
  const fuzz::InputFile& input = text.starts_with("ply")     ? ply
                                 : text.starts_with("<")     ? dae
                                 : text.starts_with("solid") ? stl
                                                             : obj;
  const std::string file = input.fill(text).string();
  std::vector<Vec3> points;
  if (!fuzz::accepts(size, file, [&] { points = geometry::read_mesh_points(file); })) return 0;
  fuzz::require(points.size() >= 3, "a mesh of less than three points");
  for (const Vec3& point : points) fuzz::require_finite(point, "a point");
  std::shared_ptr<const geometry::Mesh> hull;
  if (fuzz::accepts(size, file, [&] { hull = geometry::convex_hull(points, file); }))
    fuzz::require(hull && hull->open_edges() == 0 && hull->volume() > 0, "a hull that is no body");
  return 0;
}
