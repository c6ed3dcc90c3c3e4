#include "sim/as_built/truth.h"

#include <cmath>
#include <numbers>

namespace understudy::sim {

machine::MachineDescription true_description(const machine::MachineDescription& described,
                                             const AsBuilt& built) {
  machine::MachineDescription truth = described;
  truth.laser = built.laser;
  truth.microscope = built.microscope;
  truth.gap_sensor.reset();
  truth.tool.filament_diameter = built.filament_diameter;
  truth.process.extruder_lag = built.extruder_lag;
  return truth;
}

std::shared_ptr<const geometry::Mesh> true_part(std::shared_ptr<const geometry::Mesh> drawn,
                                                const BuiltPart& built) {
  if (!drawn) return drawn;
  if (built.size == 1 && built.ripple == 0 && built.X_WF.isApprox(Pose::Identity(), 0)) return drawn;
  const Vec3 along = 2 * std::numbers::pi / kRippleLength * Vec3::Ones().normalized();
  std::vector<Vec3> vertices = drawn->vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double wave = built.ripple * std::sin(along.dot(vertices[i]) + built.phase);
    vertices[i] = built.X_WF * Vec3(built.size * vertices[i] + wave * drawn->vertex_normals()[i]);
  }
  return std::make_shared<geometry::Mesh>(std::move(vertices), drawn->triangles());
}

}  // namespace understudy::sim
