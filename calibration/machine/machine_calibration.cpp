#include "calibration/machine/machine_calibration.h"

#include <cmath>

namespace understudy::calibration {

double residual_rms(const MachineCalibration& result, bool before) {
  double sum = 0;
  int count = 0;
  for (const PoseResidual& pose : result.poses) {
    if (!pose.used) continue;
    sum += (before ? pose.before : pose.after).head<3>().squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace understudy::calibration
