#include "calibration/bundle/sides_by_loads.h"

#include "calibration/machine/strut_sides.h"

namespace understudy::calibration {

BundleAdjustment adjust_bundle_by_loads(const machine::MachineDescription& machine, BundleProblem& problem) {
  BundleAdjustment first = adjust_bundle(problem);
  if (!first.ok() || !problem.unknowns.play) return first;
  int noted = 0;
  for (std::size_t j = 0; j < problem.poses.size(); ++j)
    noted +=
        note_sides(machine, first.state.machine.geometry, first.state.poses[j], problem.poses[j].approach);
  return noted == 0 ? first : adjust_bundle(problem);
}

}  // namespace understudy::calibration
