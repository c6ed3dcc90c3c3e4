// A program that comes line by line, and the machine that runs it meanwhile as far as a sender can see: one
// reader, one planner, and a clock that the caller moves.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "control/motion/motion_planner.h"
#include "control/motion/path_kinematics.h"
#include "machine/description.h"
#include "machine/port.h"
#include "toolpath/gcode/gcode_line_reader.h"

namespace understudy::rehearsal {

/// A limit of the machine that a line would break.
class BeyondLimits : public InputError {
 public:
  using InputError::InputError;
};

class ServedMachine {
 public:
  /// `blocks`: moves that the controller's planner holds. Both references must outlive this.
  ServedMachine(const machine::MachineDescription& machine, const toolpath::GcodeOptions& options,
                int blocks);

  /// Reads a line and queues what it moves. Throws InputError for one that means nothing here, BeyondLimits
  /// for one that the machine cannot follow: then it has done nothing, and the program has it as a comment.
  void take(const std::string& line);
  /// Everything that was taken is in the planner: the next line may come.
  bool has_room() const { return waiting_.empty(); }
  /// And the planner is empty: the tool rests.
  bool idle() const { return has_room() && done_ == pushed_; }
  /// The program has said that it ends (M2, M30).
  bool ended() const { return reader_.state().ended(); }
  /// Nothing of the program is dropped or refused.
  bool whole() const { return refused_ == 0 && !dropped_; }
  int refused() const { return refused_; }
  int moves() const { return moves_; }  ///< that were taken

  /// Lets the machine run up to `now` [s]; a clock that only advances.
  void run_until(double now);
  void hold() { held_ = true; }
  void resume() { held_ = false; }
  bool held() const { return held_; }
  /// Forgets what is queued; the tool stays where it is, and the reader knows that.
  void drop();

  const machine::MachineDescription& machine() const { return machine_; }
  const Pose& X_WT() const { return at_.X_WT; }                  ///< now
  double speed() const { return idle() || held_ ? 0 : speed_; }  ///< [m/s], of the tip
  double filament() const { return at_.setpoint.filament; }      ///< [m], fed by now
  double temperature() const { return temperature_; }            ///< [K] that is set; 0: off
  double fan() const { return fan_; }                            ///< 0..1
  int free_blocks() const { return blocks_ - static_cast<int>(pushed_ - done_); }
  /// Of G92, offsets and modes.
  const toolpath::GcodeState& state() const { return reader_.state(); }
  /// Lines that were taken, refused ones as comments.
  const std::string& text() const { return text_; }

 private:
  void check(const std::vector<toolpath::Step>& steps);
  void feed();
  void apply(const toolpath::Step& step);

  const machine::MachineDescription& machine_;
  std::string file_ = "received.gcode";
  std::vector<toolpath::Step> read_;
  toolpath::GcodeOptions options_;
  toolpath::GcodeLineReader reader_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  control::MotionLimits limits_;
  control::PathKinematics path_;
  std::unique_ptr<control::MotionPlanner> planner_;
  int blocks_;
  std::deque<toolpath::Step> waiting_;  // behind the planner's blocks
  std::size_t pushed_ = 0, done_ = 0;
  Pose X_WT_taken_;  // where the lines taken end
  kinematics::AxisVector axes_taken_{};
  control::PlannedPoint at_;
  double now_ = 0, offset_ = 0;  // [s]: machine time is the planner's and this
  double speed_ = 0, temperature_ = 0, fan_ = 0;
  double filament_before_ = 0;  // [m], before the planner in use was made
  bool held_ = false, finished_ = true, dropped_ = false;
  int line_ = 0, refused_ = 0, moves_ = 0;
  std::string text_;
};

}  // namespace understudy::rehearsal
