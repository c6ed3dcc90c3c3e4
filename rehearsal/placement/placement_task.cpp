#include "rehearsal/placement/placement_task.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "rehearsal/fixture.h"
#include "rehearsal/placement/home_posture.h"
#include "rehearsal/placement/program_place.h"
#include "rehearsal/program/program_reading.h"

namespace understudy::rehearsal {
namespace {

constexpr double kBelowTable = 0.2e-3;  // [m], by which the first layer may lie under the table
constexpr double kFirstLayer = 0.2e-3;  // [m], of a program that is lifted onto it
constexpr double kAround = 0.1;         // [m], about home, where the table is no block

Area table_area(const machine::MachineDescription& machine) {
  const Vec2 home = (machine.X_WB * machine.X_BT_home).translation().head<2>();
  const auto* block = std::get_if<geometry::Box>(&machine.table.form);
  if (block == nullptr) return {home - Vec2::Constant(kAround), home + Vec2::Constant(kAround)};
  const Vec2 middle = machine.table.X_FS.translation().head<2>(), half = block->size.head<2>() / 2;
  return {middle - half, middle + half};
}

ProgramPath read_path(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  machine::MachineDescription elsewhere = machine;
  elsewhere.X_BT_home.translation() += Vec3(0.0123, 0.0234, 0.0345);  // anywhere but at home
  return program_path(read_program(request, machine).program, read_program(request, elsewhere).program);
}

/// Slides that go elsewhere are another part, once the table turns.
void require_movable(RehearsalRequest at_origin, const PlacementTask& task) {
  const Vec3 by(1e-3, 2e-3, 0);
  at_origin.dialect.place_mm = {to_mm(by.x()), to_mm(by.y()), 0};
  const ProgramPath moved = read_path(at_origin, task.machine);
  for (std::size_t i = 0; i < task.path.poses.size(); ++i) {
    const Vec3 off = moved.poses[i].X_WT.translation() - task.path.poses[i].X_WT.translation() - by;
    if (off.norm() > 1e-9)
      throw InputError({at_origin.program, task.path.poses[i].line, 0},
                       "X Y Z state slides here while the table turns: the part cannot be moved on it");
  }
}

/// Only as far as it must be: programs count z from the top of the table.
double height_of(const RehearsalRequest& request, const ProgramPath& path) {
  const DialectRequest& dialect = request.dialect;
  if (!dialect.place_auto && dialect.place_mm[2] != 0) return from_mm(dialect.place_mm[2]);
  return path.lowest < -kBelowTable ? from_mm(told_mm(kFirstLayer - path.lowest)) : 0;
}

}  // namespace

std::pair<int, int> grid_size(const Area& area, int longer) {
  const Vec2 size = area.upper - area.lower;
  const auto points = [&](double side) {
    return std::max(2, static_cast<int>(std::lround((longer - 1) * side / size.maxCoeff())) + 1);
  };
  return {points(size.x()), points(size.y())};
}

double told_mm(double length) { return std::round(1e3 * to_mm(length)) / 1e3 + 0.0; }

PlacementTask read_placement_task(const RehearsalRequest& request) {
  PlacementTask task;
  task.machine = machine::load_machine(request.machine);
  stand_at_home(request.home_axes, task.machine);
  const RehearsalRequest at_origin = placed(request, {});
  task.path = read_path(at_origin, task.machine);
  if (task.path.turns) require_movable(at_origin, task);
  task.path.height = height_of(request, task.path);
  task.area = table_area(task.machine);
  if (!request.fixture.empty())
    task.obstacle = read_fixture(machine::find_fixture(request.fixture), task.machine);
  return task;
}

}  // namespace understudy::rehearsal
