#include "sim/collision/watched_pair.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

double below(double value, double accuracy) {
  if (std::isinf(value)) return value;
  return value - std::max(accuracy, kRelativeAccuracy * std::abs(value));
}

}  // namespace

double allowed_motion(double clearance, const Watch& watch) {
  double level = below(watch.deepest, watch.accuracy);
  if (clearance > watch.near) {
    level = watch.near;
  } else if (clearance > watch.contact) {
    level = std::max(watch.contact, level);
  }
  level = std::max(level, below(watch.least, watch.accuracy));
  return std::max(clearance - level, watch.resolution);
}

}  // namespace understudy::sim
