// A camera that runs by itself: frames come when they come, each with the time of its exposure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/image.h"

namespace understudy::drivers {

/// [s] since 1970, of the computer: what stamps of frames are in.
double wall_clock();

struct TimedImage {
  Image image;               ///< of the whole sensor
  double exposed_at = 0;     ///< [s], wall_clock()
  std::uint64_t number = 0;  ///< counts what the camera delivered, from 0
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The newest frame that no call has returned yet; nothing when there is none. Does not wait for one.
  virtual std::optional<TimedImage> newest() = 0;
  /// Why no frame will come any more; empty while they come.
  virtual std::string ended() const = 0;
};

}  // namespace understudy::drivers
