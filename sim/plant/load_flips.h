// When the load of a drive changes its side, and what is loose falls across its play.
#pragma once

#include <deque>
#include <vector>

#include "kinematics/axis_vector.h"

namespace understudy::sim {

struct LoadFlip {
  double time = 0;  ///< [s]
  int axis = 0;     ///< from 0
};

/// A flip is a load from beyond 0.5 N to beyond -0.5 N or back, as a mean over 30 ms: half of what a strut of
/// the shipped hexapod carries at home. Blows, with which a part meets its stop, are shorter, and a strut on
/// its way through its play carries its nut alone.
class LoadFlips {
 public:
  static constexpr double kWindow = 0.03;    ///< [s]
  static constexpr double kThreshold = 0.5;  ///< [N]
  static constexpr std::size_t kMost = 2000;

  /// Of the first `axes` of what is added.
  explicit LoadFlips(int axes);

  /// In order of time.
  void add(double time, const kinematics::AxisVector& load);
  const std::vector<LoadFlip>& flips() const { return flips_; }  ///< the first kMost
  std::size_t count() const { return count_; }                   ///< all

 private:
  struct Sample {
    double time;
    kinematics::AxisVector load;
  };

  std::size_t axes_;
  std::deque<Sample> window_;
  kinematics::AxisVector sum_{};
  kinematics::PerAxis<int> side_{};
  std::vector<LoadFlip> flips_;
  std::size_t count_ = 0;
};

}  // namespace understudy::sim
