#include "control/print.h"

#include <cmath>

#include <fmt/format.h>

#include "control/approach.h"
#include "control/setpoint_streamer.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::control {

using machine::Status;
using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kOutputPatience = 5.0;    // [s]
constexpr double kSurfaceRadius = 2.5e-3;  // [m], around S: the dot of every gap on the way lies inside
constexpr double kAtHome = 50e-6;          // [m or rad]: drives that rest at home read this or less beside it

/// Straight moves along the tool axis for the gap controller, at the approach's own feed.
class ApproachMotion : public GapMotion {
 public:
  ApproachMotion(SetpointStreamer& feeder, const Step& approach) : feeder_(feeder), approach_(approach) {}

  Status move_to(const Pose& X_WT) override {
    Step step = approach_;
    step.X_WT = X_WT;
    step.duration = 0;
    step.filament = 0;
    if (const Status s = feeder_.push(step); s != Status::ok) return s;
    return feeder_.come_to_rest();
  }
  machine::MachinePort& port() override { return feeder_.port(); }

 private:
  SetpointStreamer& feeder_;
  const Step& approach_;
};

/// Where the tool stands before the first step: home, unless the drives read otherwise.
Pose standing_pose(const machine::MachineDescription& machine, const machine::MachinePort& port) {
  const auto mechanism = machine.make_mechanism();
  const auto axes = static_cast<std::size_t>(mechanism->axis_count());
  const kinematics::AxisVector measured = port.state().position;
  kinematics::AxisVector home{};
  const std::span<double> home_axes(home.data(), axes);
  bool at_home = mechanism->inverse(machine.X_BT_home, home_axes, home_axes) == kinematics::SolveStatus::ok;
  for (std::size_t i = 0; i < axes; ++i) at_home = at_home && std::abs(measured[i] - home[i]) <= kAtHome;
  if (at_home) return machine.X_WB * machine.X_BT_home;
  Pose X_BT;
  const kinematics::SolveStatus solved =
      mechanism->forward(std::span<const double>(measured.data(), axes), machine.X_BT_home, X_BT);
  if (solved != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format("the drives read axis positions that belong to no pose of the machine: {}",
                                   kinematics::to_string(solved)));
  return machine.X_WB * X_BT;
}

class PrintLoop {
 public:
  PrintLoop(const toolpath::Program& program, const machine::MachineDescription& machine,
            machine::MachinePort& port, const PrintOptions& options, PrintObserver* observer)
      : program_(program),
        machine_(machine),
        port_(port),
        options_(options),
        observer_(observer),
        laid_(options.gap_control == GapControl::off ? DepositedBeadMap()
                                                     : DepositedBeadMap(program, machine)),
        watch_(make_watch()),
        feeder_(machine, port, standing_pose(machine, port), watch_.get()),
        started_at_(port.now()) {}

  PrintResult run() {
    try {
      for (std::size_t i = 0; i < program_.steps.size(); ++i) {
        stop_if_interrupted();
        if (program_.steps[i].kind == StepKind::end) break;
        if (!perform(i)) return finish(false);
        if (observer_) observer_->progress(i + 1, program_.steps.size(), port_.now());
      }
      if (const Status s = feeder_.come_to_rest(); s != Status::ok) return finish(fail(s, last_line_));
    } catch (const Interrupted&) {
      make_safe();
      throw;
    } catch (const InputError& error) {
      // The offset can carry a pose over a limit that the program itself keeps, and a part may not lie where
      // the program begins: what was planned before this step still ends at rest.
      if (feeder_.come_to_rest() != Status::ok) port_.urgent(machine::UrgentCommand::stop);
      make_safe();
      result_.status = Status::rejected;
      result_.stop_line = last_line_;
      result_.stop_reason = error.what();
      return finish(false);
    }
    return finish(true);
  }

 private:
  std::unique_ptr<ContinuousGapController> make_watch() {
    if (options_.gap_control != GapControl::continuous) return nullptr;
    GapFollowerOptions following = options_.following.value_or(gap_follower_options(machine_));
    if (!options_.following && options_.gap.aim > 0) following.aim = options_.gap.aim;
    return std::make_unique<ContinuousGapController>(machine_, options_.part, laid_, options_.gap, following,
                                                     port_,
                                                     [this](double time, int line, const Vec3& offset_W) {
                                                       tell({time, line, offset_W, true});
                                                     });
  }

  void tell(const OffsetChange& change) {
    result_.offsets.push_back(change);
    if (observer_) observer_->offset_changed(change);
  }

  /// False: the print ends here and result_ says why.
  bool perform(std::size_t index) {
    const Step& step = program_.steps[index];
    last_line_ = step.line;
    switch (step.kind) {
      case StepKind::temperature:
        // M109 waits for the heater, which reports nothing through the port: the temperature is set and the
        // print goes on.
        outputs_.nozzle_temperature = step.temperature;
        return apply_outputs(step.line);
      case StepKind::fan:
        outputs_.fan = step.fan;
        return apply_outputs(step.line);
      case StepKind::end:
        return true;
      case StepKind::move:
        if (options_.gap_control != GapControl::off && is_approach(program_, index))
          return approach(step, index);
        return move(step);
      case StepKind::travel:
      case StepKind::print:
      case StepKind::home:
      case StepKind::dwell:
        return move(step);
    }
    return true;
  }

  bool move(const Step& step) {
    Step shifted = step;
    shifted.X_WT.translation() += offset_;
    if (watch_ && !watch_->active() && step.kind == StepKind::print) watch_->start_unknown(offset_);
    const Vec3 from = feeder_.resting_pose().translation();
    if (const Status s = feeder_.push(shifted); s != Status::ok) return fail(s, step.line);
    count(step, (shifted.X_WT.translation() - from).norm());
    return true;
  }

  bool apply_outputs(int line) {
    // What the program says in between two moves holds between them: the motion before comes to rest first.
    if (const Status s = feeder_.come_to_rest(); s != Status::ok) return fail(s, line);
    const Status s = port_.set_outputs(outputs_, port_.now() + kOutputPatience);
    return s == Status::ok || fail(s, line);
  }

  /// Over the nominal part.
  double programmed_height(const Pose& X_WT) const {
    if (!options_.part) return machine_.gap.aim;
    return height_over(*options_.part, X_WT, kSurfaceRadius).value_or(machine_.gap.aim);
  }

  bool approach(const Step& step, std::size_t index) {
    if (const Status s = feeder_.come_to_rest(); s != Status::ok) return fail(s, step.line);
    take_over_correction();
    const Pose X_WT_before = pose_before(program_, index, step.X_WT);
    const double standoff = (step.X_WT.translation() - X_WT_before.translation()).norm();
    const LocalSurface surface =
        options_.part ? local_surface(*options_.part, step.X_WT, kSurfaceRadius) : LocalSurface{};
    if (!result_.approaches.empty() &&
        !dot_on_ground(machine_, surface, laid_, step.X_WT, programmed_height(step.X_WT), step.line)) {
      result_.unmeasured_starts.push_back(step.line);
      return move(step);
    }
    Pose X_WT_start = step.X_WT;
    X_WT_start.translation() += offset_;
    const Vec3 from = feeder_.resting_pose().translation();
    ApproachMotion motion(feeder_, step);
    GapApproach record{step.line, 0,
                       close_gap(machine_, surface, X_WT_start, standoff, motion, options_.gap)};
    record.done_at = port_.now();
    const bool reached = record.outcome.stop == GapStop::none;
    if (reached) {
      offset_ += record.outcome.offset_W;
      tell({port_.now(), step.line, offset_});
      if (watch_) watch_->start(offset_, record.outcome.gap, record.outcome.sigma);
      count(step, (feeder_.resting_pose().translation() - from).norm());
    } else {
      make_safe();
      result_.stop_line = step.line;
      result_.stop_reason = fmt::format("{}: {}", to_string(record.outcome.stop), record.outcome.why);
      result_.fault = port_.state().fault;
      if (result_.fault != machine::Fault::none) result_.status = Status::faulted;
    }
    result_.approaches.push_back(std::move(record));
    return reached;
  }

  /// What was corrected along the path becomes part of the offset that the poses carry.
  void take_over_correction() {
    if (!watch_) return;
    const Vec3 correction_W = watch_->release() * tool_axis(feeder_.resting_pose());
    offset_ += correction_W;
    feeder_.shift_rest(correction_W);
  }

  void count(const Step& step, double way) {
    if (!toolpath::moves(step)) return;
    ++result_.moves;
    if (step.filament > 0) result_.extruded += step.filament;
    if (step.kind != StepKind::print) result_.travel += way;
  }

  bool fail(Status status, int line) {
    if (watch_ && watch_->stop() != GapStop::none && port_.state().fault == machine::Fault::none)
      return stop_following();
    result_.status = status;
    result_.fault = port_.state().fault;
    result_.stop_line = line;
    result_.stop_reason = status == Status::faulted
                              ? fmt::format("the machine reports a fault: {}", to_string(result_.fault))
                              : fmt::format("the machine did not take the motion: {}", to_string(status));
    make_safe();
    return false;
  }

  /// The gap is not known any more, or too small: up along the tool axis from where the tool comes to rest.
  bool stop_following() {
    GapFollowing& following = watch_->following();
    const double filament = watch_->filament_at(port_.now());
    const double retreat = options_.gap.retreat;
    const std::string failed = lift(retreat, filament);
    following.why += failed.empty() ? fmt::format("; retreated by {:.3f} mm", to_mm(retreat))
                                    : fmt::format("; could not retreat: {}", failed);
    result_.stop_line = following.line;
    result_.stop_reason = fmt::format("{}: {}", to_string(following.stop), following.why);
    make_safe();
    result_.fault = port_.state().fault;
    if (result_.fault != machine::Fault::none) result_.status = Status::faulted;
    return false;
  }

  /// Says why not; empty: done.
  std::string lift(double height, double filament) {
    try {
      const Status braked = feeder_.abandon(filament);
      static_cast<void>(watch_->release());  // the tool rests where it was shifted to
      if (braked != Status::ok) return to_string(braked);
      Step up;
      up.kind = StepKind::travel;
      up.line = last_line_;
      up.X_WT = feeder_.resting_pose();
      up.X_WT.translation() += height * tool_axis(up.X_WT);
      if (const Status s = feeder_.push(up); s != Status::ok) return to_string(s);
      const Status s = feeder_.come_to_rest();
      return s == Status::ok ? "" : to_string(s);
    } catch (const InputError& error) {
      return error.what();
    }
  }

  /// Nothing moves on and nothing stays hot once the print has ended early. A port that is lost cannot obey.
  void make_safe() {
    static_cast<void>(port_.urgent(machine::UrgentCommand::stop));
    static_cast<void>(port_.set_outputs({}, port_.now() + kOutputPatience));
  }

  PrintResult finish(bool completed) {
    result_.completed = completed;
    result_.duration = port_.now() - started_at_;
    if (watch_) result_.following = std::move(watch_->following());
    return std::move(result_);
  }

  const toolpath::Program& program_;
  const machine::MachineDescription& machine_;
  machine::MachinePort& port_;
  const PrintOptions& options_;
  PrintObserver* observer_;
  DepositedBeadMap laid_;
  std::unique_ptr<ContinuousGapController> watch_;
  SetpointStreamer feeder_;
  const double started_at_;
  machine::Outputs outputs_;
  PrintResult result_;
  Vec3 offset_{0, 0, 0};
  int last_line_ = 0;
};

}  // namespace

PrintResult print(const toolpath::Program& program, const machine::MachineDescription& machine,
                  machine::MachinePort& port, const PrintOptions& options, PrintObserver* observer) {
  return PrintLoop(program, machine, port, options, observer).run();
}

}  // namespace understudy::control
