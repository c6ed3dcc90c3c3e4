// A port without a machine: axes are where the setpoints say, frames come from a function. For tests of
// everything that speaks to a MachinePort, and for dry runs.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "machine/setpoint_queue.h"

namespace understudy::machine {

class LoopbackPort : public MachinePort {
 public:
  struct Options {
    int axis_count = 6;
    std::size_t queue_capacity = 4096;
    AxisVector start{};
    AxisVector drive_zero{};  ///< [m or rad], from where the drives count: what they read is rounded by that
    std::vector<kinematics::AxisRange> ranges;  ///< one an axis; empty: without end
    double frame_time = 0.02;                   ///< [s], exposure plus transfer
    bool history = true;                        ///< keep every executed setpoint, which allocates
    double clock_step = 0;                      ///< [s], grain of the clock, as a twin's; 0: none
  };
  /// Fills the image for the axis positions at a time; false: no frame.
  using FrameSource = std::function<bool(const AxisState&, const Region&, Image&)>;

  explicit LoopbackPort(const Options& options, FrameSource frames = {});

  int axis_count() const override { return options_.axis_count; }
  double now() const override { return time_; }
  AxisState state() const override;
  Status submit(std::span<const Setpoint> setpoints, double deadline) override;
  Status wait_until(double time) override;
  Status urgent(UrgentCommand command) override;
  Status set_outputs(const Outputs& outputs, double deadline) override;
  Status capture(const Region& region, Frame& frame, double deadline) override;

  /// The fault stands as soon as the clock has reached `time`.
  void inject_fault(Fault fault, double time = 0);
  /// The next `count` frames are the last one again: stale.
  void repeat_frames(int count) { repeats_ = count; }
  const Outputs& outputs() const { return outputs_; }
  /// Every setpoint that was executed, in order.
  const std::vector<Setpoint>& history() const { return history_; }

 private:
  double on_clock(double time) const;
  void execute_until(double time);
  void raise(Fault fault);

  Options options_;
  FrameSource frames_;
  double time_ = 0;
  SetpointQueue queue_;
  std::uint64_t frames_delivered_ = 0;
  Frame last_frame_;
  int repeats_ = 0;
  Fault fault_ = Fault::none;
  Fault coming_fault_ = Fault::none;
  double coming_fault_time_ = std::numeric_limits<double>::infinity();
  Outputs outputs_;
  std::vector<Setpoint> history_;
};

}  // namespace understudy::machine
