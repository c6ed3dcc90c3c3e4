#include "sim/curing/curing.h"

#include <algorithm>

namespace understudy::sim {

void CuringObserver::observe(const Snapshot& snapshot) {
  Snapshot told = snapshot;
  if (last_) {
    const double way = (snapshot.X_WT.translation() - last_->X_WT.translation()).norm(),
                 time = snapshot.time - last_->time;
    if (time > 0) speed_ = std::max(kSlowest, way / time);
    if (snapshot.filament > last_->filament) cured_ += cure_.area(speed_, gap_()) * way;
  }
  told.filament = cured_ / filament_area_;
  last_ = snapshot;
  next_.observe(told);
}

}  // namespace understudy::sim
