// The engines against each other on the motions of docs/reference.md#physics-engines: the table of
// docs/engine-agreement.md.
#include <fmt/format.h>

#include <cstdio>

#include "bench/guarded.h"
#include "bench/plant/engine_comparison.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kTimestep = 0.1e-3;  // [s]
constexpr double kGoal = 5e-6;        // [m], of the peak errors of MuJoCo and Bullet

bool print_row(const machine::MachineDescription& machine, const ReferenceMotion& motion, double play) {
  const EngineComparison row = compare_engines(machine, motion, play, kTimestep);
  fmt::print(
      "| {} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {} / {} | {:.2f} | {:.1f} | {:.2f} | {:.2f} | {:.1f} |\n",
      motion.name, to_um(play), to_um(row.mujoco.peak_error), to_um(row.bullet.peak_error),
      to_um(row.bullet_difference.peak_error), row.mujoco.flips, row.bullet.flips,
      to_um(row.bullet_difference.median), to_um(row.bullet_difference.largest),
      to_um(row.quasistatic_difference.peak_error), to_um(row.quasistatic_difference.median),
      to_um(row.quasistatic_difference.largest));
  std::fflush(stdout);
  return row.bullet_difference.peak_error <= kGoal && row.mujoco.flips == row.bullet.flips;
}

int run_all() {
  const auto hexapod = machine::load_machine("hexapod"), arm = machine::load_machine("arm");
  fmt::print(
      "| motion | play um | peak tip error um: MuJoCo | Bullet | differ by | load flips MuJoCo / Bullet |"
      " Bullet - MuJoCo um: median | largest | quasistatic - MuJoCo um: peaks differ by | median | largest "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool met = true;
  for (const double play : {0.0, 50e-6, 100e-6, 200e-6}) {
    for (const auto& motion :
         {circle_at_15_degrees(hexapod), tilt_sweep(hexapod), zigzag(hexapod, 1), zigzag(hexapod, 3)})
      met = print_row(hexapod, motion, play) && met;
    met = print_row(arm, arm_path(arm), play) && met;
  }
  return met ? 0 : 1;
}

}  // namespace
}  // namespace understudy::sim

int main() { return understudy::bench::guarded("engine_agreement", understudy::sim::run_all); }
