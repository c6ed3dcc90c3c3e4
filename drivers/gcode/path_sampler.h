// The path of a queue's setpoints, sample by sample, as its clock runs.
#pragma once

#include "drivers/gcode/block_fitter.h"
#include "drivers/pose_words.h"
#include "machine/description.h"
#include "machine/setpoint_queue.h"

namespace understudy::drivers {

class PathSampler {
 public:
  enum class Passed {
    on,       ///< nothing, or on the way
    rests,    ///< what was on the way has ended at rest
    ran_dry,  ///< or in motion: an underrun
  };

  /// The axes rest at `start`, at time 0. `words`, which must outlive this object: what blocks are written
  /// in; null: in axis positions.
  PathSampler(const machine::MachineDescription& machine, std::size_t capacity,
              const machine::AxisVector& start, PoseWords* words = nullptr);

  machine::SetpointQueue& queue() { return queue_; }
  const machine::SetpointQueue& queue() const { return queue_; }
  /// The clock runs from `now` to `next`, a sample's time at most; what it passes goes to the fitter. Where
  /// it ends, `last()` is the rest.
  Passed pass(double now, double next, BlockFitter& fitter);
  bool in_motion() const { return in_motion_; }  ///< samples were taken since it rested
  const PathSample& last() const { return last_; }
  PathSample last_in_words();  ///< as blocks are written

 private:
  machine::SetpointQueue queue_;
  PoseWords* words_;
  PathSample last_;
  bool in_motion_ = false;
};

constexpr double kSampleTime = 1e-3;  // [s], between samples

}  // namespace understudy::drivers
