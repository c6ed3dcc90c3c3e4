#include "machine/setpoint_queue.h"

#include <algorithm>
#include <cmath>

namespace understudy::machine {
namespace {

void interpolate(const Setpoint& a, const Setpoint& b, double time, SetpointQueue::Target& target) {
  const double h = b.time - a.time;
  const double u = std::clamp((time - a.time) / h, 0.0, 1.0);
  const double u2 = u * u, u3 = u2 * u;
  for (std::size_t i = 0; i < target.position.size(); ++i) {
    const double step = b.position[i] - a.position[i];
    const double va = a.velocity[i] * h, vb = b.velocity[i] * h;
    target.position[i] = a.position[i] + step * (3 * u2 - 2 * u3) + va * (u3 - 2 * u2 + u) + vb * (u3 - u2);
    target.velocity[i] = (step * (6 * u - 6 * u2) + va * (3 * u2 - 4 * u + 1) + vb * (3 * u2 - 2 * u)) / h;
  }
  target.filament = a.filament + u * (b.filament - a.filament);
  target.line = b.line;
}

}  // namespace

SetpointQueue::SetpointQueue(const SetpointQueueOptions& options, const AxisVector& start, double now)
    : ranges_(options.ranges), rest_velocity_(options.rest_velocity), ring_(options.capacity) {
  last_.position = target_.position = start;
  last_.time = now;
}

bool SetpointQueue::acceptable(const Setpoint& s) const {
  bool good = std::isfinite(s.time) && std::isfinite(s.filament);
  for (std::size_t i = 0; i < ranges_.size(); ++i)
    good = good && std::isfinite(s.position[i]) && std::isfinite(s.velocity[i]) &&
           s.position[i] >= ranges_[i].lower && s.position[i] <= ranges_[i].upper;
  return good;
}

Status SetpointQueue::submit(std::span<const Setpoint> setpoints, double now) {
  if (setpoints.size() > ring_.size()) return Status::rejected;
  if (setpoints.size() > free_slots()) return Status::queue_full;
  // The lag of a hold ends where the queue has run empty: nothing is left that is late.
  const double lag = size_ == 0 && rate_ == 1 && slope_ == 0 ? 0 : lag_;
  double time = size_ > 0 ? back().time : std::max(last_.time, now - lag);
  for (const Setpoint& s : setpoints) {
    if (!(s.time > time) || !acceptable(s)) return Status::rejected;
    time = s.time;
  }
  lag_ = lag;
  if (size_ == 0) last_.time = now - lag_;  // the axes have rested at `last_` until now
  for (const Setpoint& s : setpoints) ring_[(head_ + size_++) % ring_.size()] = s;
  accepted_ += setpoints.size();
  return Status::ok;
}

const Setpoint* SetpointQueue::execute_next(double now) {
  if (size_ == 0 || ring_[head_].time > now - lag_) return nullptr;
  last_ = ring_[head_];
  head_ = (head_ + 1) % ring_.size();
  --size_;
  ++executed_;
  return &last_;
}

const SetpointQueue::Target& SetpointQueue::advance_to(double now) {
  while (execute_next(now) != nullptr) {
  }
  if (size_ == 0) {
    target_ = {last_.position, {}, last_.filament, last_.line};
    return target_;
  }
  interpolate(last_, ring_[head_], now - lag_, target_);
  for (double& v : target_.velocity) v *= rate_;
  return target_;
}

void SetpointQueue::pass(double dt, double now) {
  if (slope_ != 0) {
    rate_ = std::clamp(rate_ + slope_ * dt, 0.0, 1.0);
    if (rate_ == 0 || rate_ == 1) slope_ = 0;
    if (stopping_ && (rate_ == 0 || (size_ == 0 && !ran_dry()))) return clear(now);
  }
  lag_ += (1 - rate_) * dt;
}

void SetpointQueue::hold() {
  if (!stopping_) slope_ = -1 / kBrakingTime;
}

void SetpointQueue::resume() {
  if (!stopping_) slope_ = 1 / kBrakingTime;
}

void SetpointQueue::stop(double now) {
  if (size_ == 0 && !ran_dry()) return clear(now);
  slope_ = -1 / kBrakingTime;
  stopping_ = true;
}

void SetpointQueue::clear(double now) {
  last_.position = target_.position;
  last_.velocity = {};
  last_.filament = target_.filament;
  last_.time = now;
  size_ = 0;
  rate_ = 1;
  slope_ = lag_ = 0;
  stopping_ = false;
}

bool SetpointQueue::ran_dry() const {
  if (size_ > 0) return false;
  for (std::size_t i = 0; i < ranges_.size(); ++i)
    if (std::abs(last_.velocity[i]) > rest_velocity_[i]) return true;
  return false;
}

}  // namespace understudy::machine
