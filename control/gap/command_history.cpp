#include "control/gap/command_history.h"

#include <algorithm>
#include <cmath>

namespace understudy::control {

CommandHistory::CommandHistory(double span, double cycle_time)
    : ring_(static_cast<std::size_t>(std::ceil(span / cycle_time))) {}

void CommandHistory::push(const Commanded& cycle) {
  ring_[head_] = cycle;
  head_ = (head_ + 1) % ring_.size();
  filled_ = std::min(filled_ + 1, ring_.size());
}

bool CommandHistory::at(double time, Commanded& found) const {
  if (filled_ == 0 || time < back(filled_ - 1).time) return false;
  if (time >= latest().time) {
    found = latest();
    return true;
  }
  std::size_t newer = 0, older = filled_ - 1;  // steps back
  while (older - newer > 1) {
    const std::size_t middle = (newer + older) / 2;
    (back(middle).time > time ? newer : older) = middle;
  }
  const Commanded &a = back(older), &b = back(newer);
  const double share = (time - a.time) / (b.time - a.time);
  const auto between = [&](double from, double to) { return from + share * (to - from); };
  found = b;
  found.time = time;
  found.path = between(a.path, b.path);
  found.correction = between(a.correction, b.correction);
  found.excitation = between(a.excitation, b.excitation);
  found.filament = between(a.filament, b.filament);
  found.X_WT = interpolate(a.X_WT, b.X_WT, share);
  return true;
}

}  // namespace understudy::control
