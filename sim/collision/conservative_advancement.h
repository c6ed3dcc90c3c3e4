// When a pair of bodies must be measured again: how far they may move after a measurement.
#pragma once

#include <limits>

namespace understudy::sim {

/// Clearances that the next query of a pair must not miss. All [m].
struct ClearanceLimits {
  double contact = 0;  ///< at or below, they touch
  double near = 0;     ///< at or below, they are near; equal to `contact` where nearness means nothing
  double deepest = std::numeric_limits<double>::infinity();  ///< least clearance on record for this line
  double least = std::numeric_limits<double>::infinity();    ///< least clearance of the group so far
  double depth_accuracy = 0;                                 ///< of a reported depth
  double accuracy = 0;                                       ///< of a reported least clearance, at the least
  double resolution = 0;                                     ///< motion that is always allowed
};

// Of the reported value, where that is more than the absolute accuracy.
constexpr double kRelativeAccuracy = 0.01;
constexpr double kRelativeDepthAccuracy = 0.05;

/// Motion that the pair may make after `clearance` was measured before any of these could be missed.
double allowed_motion(double clearance, const ClearanceLimits& limits);

}  // namespace understudy::sim
