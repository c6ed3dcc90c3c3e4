#include "calibration/machine/machine_calibration.h"

#include <cmath>

namespace understudy::calibration {

double residual_rms(const MachineCalibration& result, bool before) {
  double sum = 0;
  int count = 0;
  for (const PoseResidual& pose : result.poses) {
    if (!pose.used) continue;
    const Vec3 tip = (before ? pose.before : pose.after).head<3>();
    if (!tip.allFinite()) continue;
    sum += tip.squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace understudy::calibration
