// Bytes as an STL, text or binary.
#include <cmath>

#include "geometry/mesh.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

void check_answers(const geometry::Mesh& mesh) {
  const Vec3 middle = 0.5 * (mesh.lower() + mesh.upper());
  const double reach = 4 * (mesh.upper() - mesh.lower()).norm();
  require_finite(mesh.volume(), "volume");
  for (const Vec3& normal : mesh.vertex_normals()) require_near(normal.norm(), 1, 1e-9, 0, "normal's length");
  for (const Vec3& from : {middle, Vec3(mesh.lower()), Vec3(mesh.upper() + Vec3(0.1, 0.2, 0.3))}) {
    const geometry::SurfacePoint nearest = mesh.nearest(from);
    require_finite(nearest.position, "nearest point");
    require_near(nearest.normal.norm(), 1, 1e-9, 0, "length of the nearest point's normal");
    require_near((nearest.position - from).norm(), nearest.distance, 1e-9, 1e-9, "distance");
    require_near(std::abs(mesh.signed_distance(from)), nearest.distance, 1e-9, 1e-9, "signed distance");
    if (const auto hit = mesh.ray_hit(from, Vec3::UnitZ(), reach)) require_finite(hit->position, "hit");
  }
}

/// Corners come back as they were rounded to the file's single precision.
void check_same(const geometry::Mesh& read, const geometry::Mesh& written) {
  require(read.triangles().size() == written.triangles().size(), "another number of triangles came back");
  const double largest = written.vertices().empty()
                             ? 0
                             : written.upper().cwiseAbs().maxCoeff() + written.lower().cwiseAbs().maxCoeff();
  for (std::size_t t = 0; t < read.triangles().size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& r = read.vertices()[static_cast<std::size_t>(read.triangles()[t][k])];
      const Vec3& w = written.vertices()[static_cast<std::size_t>(written.triangles()[t][k])];
      require_near((r - w).norm(), 0, 1e-6 * largest, 0, "corner");
    }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("input.stl"), written("written.stl");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  geometry::MeshCheck open;
  open.allow_open = true;
  std::shared_ptr<const geometry::Mesh> mesh;
  if (!fuzz::accepts(size, file, [&] { mesh = geometry::read_stl(file, open); })) return 0;
  fuzz::check_answers(*mesh);
  written.fill(geometry::write_stl(*mesh, "written"));
  fuzz::check_same(*geometry::read_stl(written.path(), open), *mesh);
  // The same file where the surface must be closed.
  fuzz::accepts(size, file, [&] { mesh = geometry::read_stl(file); });
  return 0;
}
