#include "sim/collision/conservative_advancement.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

double below(double value, const Watch& watch) {
  if (std::isinf(value)) return value;
  if (value <= watch.contact) {
    return value - std::max(watch.depth_accuracy, kRelativeDepthAccuracy * std::abs(value));
  }
  return value - std::max(watch.accuracy, kRelativeAccuracy * value);
}

}  // namespace

double allowed_motion(double clearance, const Watch& watch) {
  double level = below(watch.deepest, watch);
  if (clearance > watch.near) {
    level = watch.near;
  } else if (clearance > watch.contact) {
    level = std::max(watch.contact, level);
  }
  level = std::max(level, below(watch.least, watch));
  return std::max(clearance - level, clearance > watch.contact ? watch.resolution : watch.depth_accuracy);
}

}  // namespace understudy::sim
