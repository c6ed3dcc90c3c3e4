// One picture as it is asked of the tool's microscope: the truth at an instant, and in which light.
#pragma once

#include <cstdint>
#include <functional>

#include "core/image.h"

namespace understudy::sim {

struct Shot {
  Pose X_WT = Pose::Identity();  ///< true
  Region region;                 ///< of the sensor; what lies beyond it is cut off
  std::uint64_t number = 0;      ///< counts exposures; keys the sensor's noise
  double laser = 1;              ///< power, of what the laser has by itself
  /// Keys the roughness of what the beam falls on: 0 the part's, any other a surface of its own.
  std::uint64_t surface = 0;
};

/// Takes a picture of the truth. An empty image is a lost frame.
using Exposure = std::function<Image(const Shot& shot)>;

}  // namespace understudy::sim
