#include "calibration/bundle/sides_by_loads.h"

#include "calibration/machine/strut_sides.h"

namespace understudy::calibration {
namespace {

/// The number of sides that were unknown and are known now.
int note_sides(const machine::MachineDescription& machine, const BundleState& state, BundleProblem& problem) {
  int noted = 0;
  for (std::size_t j = 0; j < problem.poses.size(); ++j) {
    const auto sides = resting_sides(machine, state.machine.geometry, machine.tolerances.after_calibration,
                                     state.poses[j]);
    for (std::size_t i = 0; i < kStruts; ++i) {
      Approach& side = problem.poses[j].approach[i];
      if (side != Approach::unknown || sides[i] == Approach::unknown) continue;
      side = sides[i];
      ++noted;
    }
  }
  return noted;
}

}  // namespace

BundleAdjustment adjust_bundle_by_loads(const machine::MachineDescription& machine, BundleProblem& problem) {
  BundleAdjustment first = adjust_bundle(problem);
  if (!first.ok() || !problem.unknowns.play || note_sides(machine, first.state, problem) == 0) return first;
  return adjust_bundle(problem);
}

}  // namespace understudy::calibration
