#include "tests/sim/collision/bodies_for_tests.h"

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "geometry/box_mesh.h"

namespace understudy::sim::test {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

Vec3 on_circle(double radius, double angle_deg, double z) {
  return {radius * std::cos(from_deg(angle_deg)), radius * std::sin(from_deg(angle_deg)), z};
}

}  // namespace

machine::MachineDescription hexapod() {
  machine::MachineDescription machine;
  machine.name = "G4";
  machine.X_WB = make_pose(Quat::Identity(), Vec3(0, 0, 0.256));
  machine.X_BT_home = make_pose(Quat::Identity(), Vec3(0, 0, -0.206));
  for (int i = 0; i < 6; ++i) {
    const int pair = i / 2;
    const double side = i % 2 == 0 ? -1 : 1;
    machine.hexapod().geometry.base_joint[static_cast<std::size_t>(i)] =
        on_circle(0.080, 120.0 * pair + side * 43, 0);
    machine.hexapod().geometry.platform_joint[static_cast<std::size_t>(i)] =
        on_circle(0.029, 120.0 * pair + side * 17, 0.025);
  }
  machine.hexapod().strut_radius = 4e-3;
  machine.tool.flat_diameter = 1e-3;
  machine.tool.bodies = {
      {"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()},
      {"heater block", geometry::Box{Vec3(16e-3, 16e-3, 10e-3)},
       make_pose(Quat::Identity(), Vec3(0, 0, 17e-3))},
      {"platform", geometry::Cylinder{33e-3, 6e-3}, make_pose(Quat::Identity(), Vec3(0, 0, 28e-3))}};
  machine.table = {"bed", geometry::Box{Vec3(0.3, 0.3, 0.01)},
                   make_pose(Quat::Identity(), Vec3(0, 0, -5e-3))};
  return machine;
}

AsBuilt as_designed(const machine::MachineDescription& machine) {
  AsBuilt as_built;
  as_built.source = "nominal";
  as_built.hexapod = machine.hexapod().geometry;
  return as_built;
}

std::shared_ptr<const geometry::Mesh> box_mesh(const Vec3& centre, const Vec3& size, const Mat3& R) {
  return geometry::box_mesh(-size / 2, size / 2, make_pose(R, centre));
}

std::shared_ptr<const geometry::Mesh> bottle_mesh(const Vec3& centre, double radius, double length,
                                                  int around, int along) {
  std::vector<Vec3> vertices;
  Triangles triangles;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      vertices.push_back(centre + Vec3(radius * std::cos(angle),
                                       length * (static_cast<double>(j) / along - 0.5),
                                       radius * std::sin(angle)));
    }
  }
  const int first = static_cast<int>(vertices.size()), last = first + 1;
  vertices.push_back(centre - Vec3(0, length / 2, 0));
  vertices.push_back(centre + Vec3(0, length / 2, 0));
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around, top = along * around;
    for (int j = 0; j < along; ++j) {
      const int a = j * around + i, b = j * around + next;
      triangles.push_back({a, a + around, b});
      triangles.push_back({b, a + around, b + around});
    }
    triangles.push_back({first, i, next});
    triangles.push_back({last, top + next, top + i});
  }
  return std::make_shared<geometry::Mesh>(std::move(vertices), triangles);
}

}  // namespace understudy::sim::test
