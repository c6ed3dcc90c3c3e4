#include "rehearsal/observers/curves_observer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understudy::rehearsal {

void CurveStretch::add(const CurveStretch& next) {
  end = next.end;
  for (std::size_t i = 0; i < force.size(); ++i) force[i].add(next.force[i]);
  nozzle_temperature.add(next.nozzle_temperature);
  interface_temperature.add(next.interface_temperature);
  nozzle_clearance.add(next.nozzle_clearance);
}

CurvesObserver::CurvesObserver(const sim::DepositionObserver& deposition,
                               const sim::CollisionObserver* collision, int struts, std::size_t capacity)
    : deposition_(deposition),
      collision_(collision),
      flips_(struts),
      capacity_(2 * std::max<std::size_t>(1, capacity / 2)) {}

void CurvesObserver::observe(const sim::Snapshot& s) {
  CurveStretch now;
  now.begin = now.end = s.time;
  for (std::size_t i = 0; i < now.force.size(); ++i) now.force[i].add(s.drive_force[i]);
  if (s.nozzle_temperature > 0) now.nozzle_temperature.add(s.nozzle_temperature);
  const double interface = deposition_.interface_temperature();
  if (deposition_.flowing() && std::isfinite(interface)) now.interface_temperature.add(interface);
  const double clearance = collision_ ? collision_->nozzle_clearance_seen() : HUGE_VAL;
  if (std::isfinite(clearance)) now.nozzle_clearance.add(clearance);
  flips_.add(s.time, s.drive_force);
  if (in_last_ < stride_ && !stretches_.empty()) {
    stretches_.back().add(now);
    ++in_last_;
    return;
  }
  if (stretches_.size() >= capacity_) {
    join_pairs();
    stride_ *= 2;
  }
  stretches_.push_back(now);
  in_last_ = 1;
}

void CurvesObserver::join_pairs() {
  const std::size_t half = stretches_.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    CurveStretch joined = stretches_[2 * i];
    joined.add(stretches_[2 * i + 1]);
    stretches_[i] = joined;
  }
  stretches_.resize(half);
}

RunCurves CurvesObserver::take() {
  RunCurves curves;
  curves.stretches = std::move(stretches_);
  curves.flips = flips_.flips();
  curves.flip_count = flips_.count();
  return curves;
}

}  // namespace understudy::rehearsal
