#include "calibration/machine/calibrate_by_loads.h"

#include "calibration/machine/strut_sides.h"

namespace understudy::calibration {

Calibration calibrate_by_loads(const machine::MachineDescription& machine, const Estimator& estimator,
                               Problem& problem, const Options& options) {
  Calibration first = estimator.calibrate(problem, options);
  if (!first.ok() || !estimator.unknowns().play) return first;
  int noted = 0;
  for (PoseSample& sample : problem.samples)
    noted += note_sides(machine, first.parameters.geometry, sample.X_BT, sample.approach);
  return noted == 0 ? first : estimator.calibrate(problem, options);
}

}  // namespace understudy::calibration
