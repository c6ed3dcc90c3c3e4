#include "sim/collision/conservative_advancement.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

double below(double value, const ClearanceLimits& limits) {
  if (std::isinf(value)) return value;
  if (value <= limits.contact) {
    return value - std::max(limits.depth_accuracy, kRelativeDepthAccuracy * std::abs(value));
  }
  return value - std::max(limits.accuracy, kRelativeAccuracy * value);
}

}  // namespace

double allowed_motion(double clearance, const ClearanceLimits& limits) {
  double level = below(limits.deepest, limits);
  if (clearance > limits.near) {
    level = limits.near;
  } else if (clearance > limits.contact) {
    level = std::max(limits.contact, level);
  }
  level = std::max(level, below(limits.least, limits));
  return std::max(clearance - level, clearance > limits.contact ? limits.resolution : limits.depth_accuracy);
}

}  // namespace understudy::sim
