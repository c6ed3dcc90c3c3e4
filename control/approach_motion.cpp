#include "control/approach_motion.h"

namespace understudy::control {

machine::Status ApproachMotion::move_to(const Pose& X_WT) {
  toolpath::Step step = approach_;
  step.X_WT = X_WT;
  step.duration = 0;
  step.filament = 0;
  if (const Stop stop = cycle_.push(step)) return stop.status;
  return cycle_.come_to_rest().status;
}

}  // namespace understudy::control
