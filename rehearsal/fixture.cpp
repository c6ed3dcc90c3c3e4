#include "rehearsal/fixture.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/file_cache.h"
#include "core/units.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/collision.h"

namespace understudy::rehearsal {
namespace {

constexpr double kSinks = 0.05e-3;  // [m]: an object that was modelled to stand on the table may round so far

void check_table(const std::string& path, const geometry::Mesh& mesh) {
  if (mesh.lower().z() >= -kSinks) return;
  throw InputError({path, 0, 0},
                   fmt::format("the object reaches {:.3f} mm below the table's top, more than {:g} mm",
                               -to_mm(mesh.lower().z()), to_mm(kSinks)));
}

void check_home(const std::string& path, const std::shared_ptr<const geometry::Mesh>& mesh,
                const machine::MachineDescription& machine) {
  sim::CollisionObserver bodies(machine, sim::as_described(machine), mesh, {});
  sim::Snapshot home;
  home.X_WT = machine.X_WB * machine.X_BT_home;
  const auto mechanism = machine.make_mechanism();
  const auto axes = static_cast<std::size_t>(mechanism->axis_count());
  if (mechanism->inverse(machine.X_BT_home, {}, std::span(home.axes_reached).first(axes)) !=
      kinematics::SolveStatus::ok)
    return;  // told when the machine is started
  bodies.observe(home);
  for (const sim::Contact& contact : bodies.collisions()) {
    if (contact.obstacle != "part" && contact.body != "part") continue;
    throw InputError({path, 0, 0},
                     fmt::format("the object stands where the {} of {} is at home, {:.3f} mm deep",
                                 contact.body, machine.name, std::max(0.0, -to_mm(contact.clearance))));
  }
}

}  // namespace

std::shared_ptr<const geometry::Mesh> read_fixture(const std::string& path,
                                                   const machine::MachineDescription& machine) {
  // It builds its tree of triangles when it is first asked, for whoever shares it.
  auto mesh = *cached<std::shared_ptr<const geometry::Mesh>>(path, [&] { return geometry::read_stl(path); });
  check_table(path, *mesh);
  check_home(path, mesh, machine);
  return mesh;
}

}  // namespace understudy::rehearsal
