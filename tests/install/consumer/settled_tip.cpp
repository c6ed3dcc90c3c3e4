// The twin's mechanics without its controller: where the tip comes to rest under gravity and play.
#include <cstdio>
#include <exception>
#include <span>

#include "sim/plant/plant.h"

int main() try {
  using namespace understudy;
  const machine::MachineDescription machine = machine::load_machine(HEXAPOD);
  kinematics::AxisVector drives{};
  const auto axes = std::span<double>(drives).first(6);
  if (machine.make_mechanism()->inverse(machine.X_BT_home, {}, axes) != kinematics::SolveStatus::ok) return 1;
  const auto zero = machine.drive_zero();
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] -= zero[i];
  const auto plant = sim::make_quasistatic_plant(machine, sim::make_as_built(machine, "nominal", 0));
  plant->reset(drives);
  const Vec3 off = plant->tool_pose().translation() - (machine.X_WB * machine.X_BT_home).translation();
  std::printf("%s: the tip rests %.1f um from home\n", plant->engine().c_str(), 1e6 * off.norm());
  return off.norm() < 1e-3 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
