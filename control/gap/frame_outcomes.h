// What became of the last frames: a reading, or the reason why there was none. Nothing here allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "control/gap/gap_stop.h"

namespace understudy::control {

class FrameOutcomes {
 public:
  static constexpr int kFrames = 24;

  /// GapStop::none: it gave a reading.
  void add(GapStop why) {
    frames_[next_] = why;
    next_ = (next_ + 1) % frames_.size();
  }

  int missed() const {
    return kFrames - static_cast<int>(std::count(frames_.begin(), frames_.end(), GapStop::none));
  }
  /// Most of them gave none.
  bool blind() const { return 2 * missed() > kFrames; }
  /// The reason that most of those had; of several the first in GapStop.
  GapStop reason() const {
    std::array<int, 16> counts{};
    for (const GapStop why : frames_)
      if (why != GapStop::none) ++counts[static_cast<std::size_t>(why)];
    return static_cast<GapStop>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }

 private:
  std::array<GapStop, kFrames> frames_{};
  std::size_t next_ = 0;
};

}  // namespace understudy::control
