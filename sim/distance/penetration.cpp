#include "sim/distance/penetration.h"

#include <limits>
#include <optional>
#include <vector>

#include "geometry/mesh.h"
#include "sim/distance/convex_solid.h"

namespace understudy::sim {
namespace {

const geometry::Mesh* mesh_of(const geometry::Shape& shape) {
  const auto* form = std::get_if<geometry::MeshShape>(&shape.form);
  return form ? form->mesh.get() : nullptr;
}

std::vector<Ball> balls_of(const geometry::Shape& shape) {
  const geometry::Mesh* mesh = mesh_of(shape);
  if (!mesh) return surface_balls(*convex_solid(shape));
  std::vector<Ball> balls;
  balls.reserve(mesh->vertices().size());
  for (const Vec3& v : mesh->vertices()) balls.push_back({v, 0});
  return balls;
}

constexpr double kRounding = 1e-12;  // [m]

/// How far the last place that was looked at is from the other body: places around it are as far, but for the
/// way there.
struct Looked {
  Vec3 place{0, 0, 0};
  double distance = 0;
};

void deepen(const geometry::Shape& a, const Pose& X_Wa, const geometry::Shape& b, const Pose& X_Wb,
            Penetration& deepest) {
  const geometry::Mesh* mesh = mesh_of(b);
  if (mesh && mesh->open_edges() > 0) return;
  const auto solid = convex_solid(b);
  const Pose X_ba = X_Wb.inverse(Eigen::Isometry) * X_Wa;
  std::optional<Looked> last;
  for (const Ball& ball : balls_of(a)) {
    const Vec3 p = X_ba * ball.centre;
    if (last && ball.radius - last->distance + (p - last->place).norm() < deepest.depth - kRounding) continue;
    last = {p, mesh ? mesh->signed_distance(p) : signed_distance(*solid, p)};
    const double depth = ball.radius - last->distance;
    if (depth > deepest.depth) deepest = {depth, X_Wb * p};
  }
}

}  // namespace

Penetration penetration(const geometry::Shape& a, const Pose& X_Wa, const geometry::Shape& b,
                        const Pose& X_Wb) {
  Penetration deepest;
  deepen(a, X_Wa, b, X_Wb, deepest);
  deepen(b, X_Wb, a, X_Wa, deepest);
  return deepest;
}

bool contains(const geometry::Shape& shape, const Vec3& p_S) {
  const geometry::Mesh* mesh = mesh_of(shape);
  if (mesh) return mesh->open_edges() == 0 && mesh->signed_distance(p_S) < 0;
  return signed_distance(*convex_solid(shape), p_S) < 0;
}

Vec3 point_of(const geometry::Shape& shape) {
  const geometry::Mesh* mesh = mesh_of(shape);
  return mesh ? mesh->vertices().front() : Vec3(Vec3::Zero());
}

}  // namespace understudy::sim
