// What was commanded over the last half second, by time: a frame shows the tool where it was in the middle of
// its exposure. Memory is fixed once made.
#pragma once

#include <vector>

#include "core/frames.h"

namespace understudy::control {

/// One planned cycle as it was handed to the port.
struct Commanded {
  double time = 0;               ///< [s]
  double path = 0;               ///< [m], of the tip since the control began; turns count
  double correction = 0;         ///< [m], along the tool axis
  double excitation = 0;         ///< [m], its deliberate part
  double filament = 0;           ///< [m]
  Pose X_WT = Pose::Identity();  ///< before the correction
  bool printing = false;         ///< filament is fed on the way here
  int line = 0;
};

class CommandHistory {
 public:
  /// Remembers `span` [s] of cycles.
  CommandHistory(double span, double cycle_time);

  void clear() { filled_ = head_ = 0; }
  void push(const Commanded& cycle);
  bool empty() const { return filled_ == 0; }
  const Commanded& latest() const { return back(0); }
  /// Straight between the two cycles around a time; after the latest, the latest. False: not remembered.
  bool at(double time, Commanded& found) const;

 private:
  const Commanded& back(std::size_t steps) const {
    return ring_[(head_ + ring_.size() - 1 - steps) % ring_.size()];
  }

  std::vector<Commanded> ring_;
  std::size_t head_ = 0, filled_ = 0;
};

}  // namespace understudy::control
