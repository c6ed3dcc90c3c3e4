#include "control/print.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/approach.h"
#include "control/approach_motion.h"
#include "control/cycle.h"
#include "control/standing_pose.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"

namespace understudy::control {

using machine::Status;
using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kOutputPatience = 5.0;  // [s]

class PrintLoop {
 public:
  PrintLoop(const toolpath::Program& program, const machine::MachineDescription& machine,
            machine::MachinePort& port, const PrintOptions& options, PrintObserver* observer)
      : program_(program),
        machine_(machine),
        port_(port),
        options_(options),
        observer_(observer),
        approach_(options.gap.value_or(gap_controller_options(machine))),
        part_{options.part, options.gap_control == GapControl::off ? DepositedBeadMap()
                                                                   : DepositedBeadMap(program, machine)},
        gap_(make_gap_controller()),
        cycle_(machine, port, standing_pose(machine, port), {gap_.get(), options.poses}),
        started_at_(port.now()),
        offset_(options.offset_W) {
    if (part_.mesh != nullptr) make_ready(*part_.mesh);
  }

  PrintResult run() {
    try {
      result_.stop = perform_all();
      if (result_.stop) end_early();
    } catch (const Interrupted&) {
      make_safe();
      throw;
    } catch (const InputError& error) {
      // The offset can carry a pose over a limit that the program itself keeps, and a part may not lie where
      // the program begins: what was planned before this step still ends at rest.
      static_cast<void>(cycle_.come_to_rest());
      make_safe();
      result_.stop.status = Status::rejected;
      result_.stop.why = error.what();
      result_.stop.time = port_.now();
    }
    result_.completed = !result_.stop;
    if (result_.stop && result_.stop.line == 0) result_.stop.line = line_of_stop();
    result_.duration = port_.now() - started_at_;
    if (gap_) result_.following = std::move(gap_->following());
    return std::move(result_);
  }

 private:
  std::unique_ptr<ContinuousGapController> make_gap_controller() {
    if (options_.gap_control != GapControl::continuous) return nullptr;
    GapFollowerOptions following = options_.following.value_or(gap_follower_options(machine_));
    if (!options_.following && approach_.aim > 0) following.aim = approach_.aim;
    return std::make_unique<ContinuousGapController>(machine_, part_,
                                                     ContinuousGapOptions{approach_, following}, port_,
                                                     [this](const OffsetChange& change) { publish(change); });
  }

  void publish(const OffsetChange& change) {
    result_.offsets.push_back(change);
    if (observer_) observer_->offset_changed(change);
  }

  Stop perform_all() {
    for (std::size_t i = 0; i < program_.steps.size(); ++i) {
      stop_if_interrupted();
      if (program_.steps[i].kind == StepKind::end) break;
      last_line_ = program_.steps[i].line;
      if (Stop stop = perform(i)) return stop;
      if (observer_) observer_->progress(i + 1, program_.steps.size(), port_.now());
    }
    return cycle_.come_to_rest();
  }

  Stop perform(std::size_t index) {
    const Step& step = program_.steps[index];
    switch (step.kind) {
      case StepKind::temperature:
        // M109 waits for the heater, which reports nothing through the port: the temperature is set and the
        // print goes on.
        outputs_.nozzle_temperature = step.temperature;
        return apply_outputs();
      case StepKind::fan:
        outputs_.fan = step.fan;
        return apply_outputs();
      case StepKind::end:
        return {};
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
    return {};
  }

  Stop move(const Step& step) {
    Step shifted = step;
    shifted.X_WT.translation() += offset_;
    if (gap_ && !gap_->active() && step.kind == StepKind::print) gap_->start_unknown(offset_);
    const Vec3 from = cycle_.resting_pose().translation();
    if (Stop stop = cycle_.push(shifted)) return stop;
    count(step, (shifted.X_WT.translation() - from).norm());
    return {};
  }

  Stop apply_outputs() {
    // What the program says in between two moves holds between them: the motion before comes to rest first.
    if (Stop stop = cycle_.come_to_rest()) return stop;
    return stop_of(port_.set_outputs(outputs_, port_.now() + kOutputPatience), port_);
  }

  /// Over the nominal part.
  double programmed_height(const Pose& X_WT) const {
    if (!part_.mesh) return machine_.gap.aim;
    return height_over(*part_.mesh, X_WT).value_or(machine_.gap.aim);
  }

  Stop approach(const Step& step, std::size_t index) {
    if (Stop stop = cycle_.come_to_rest()) return stop;
    take_over_correction();
    const Pose X_WT_before = pose_before(program_, index, step.X_WT);
    const double standoff = (step.X_WT.translation() - X_WT_before.translation()).norm();
    const LocalSurface surface = part_.mesh ? local_surface(*part_.mesh, step.X_WT) : LocalSurface{};
    if (!result_.approaches.empty() &&
        !dot_on_ground(machine_, surface, part_.beads, step.X_WT, programmed_height(step.X_WT), step.line)) {
      result_.unmeasured_starts.push_back(step.line);
      return move(step);
    }
    Pose X_WT_start = step.X_WT;
    X_WT_start.translation() += offset_;
    const Vec3 from = cycle_.resting_pose().translation();
    ApproachMotion motion(cycle_, step);
    GapApproach record{step.line, 0, close_gap(machine_, surface, X_WT_start, standoff, motion, approach_)};
    record.done_at = port_.now();
    result_.approaches.push_back(std::move(record));
    const GapOutcome& outcome = result_.approaches.back().outcome;
    if (outcome.stop != GapStop::none) return stop_of(outcome.stop, outcome.why, port_);
    offset_ += outcome.offset_W;
    publish({port_.now(), step.line, offset_});
    if (gap_) gap_->start(offset_, outcome.gap, outcome.sigma);
    count(step, (cycle_.resting_pose().translation() - from).norm());
    return {};
  }

  /// What was corrected along the path becomes part of the offset that the poses carry.
  void take_over_correction() {
    if (!gap_) return;
    const Vec3 correction_W = gap_->release() * tool_axis(cycle_.resting_pose());
    offset_ += correction_W;
    cycle_.shift_rest(correction_W);
  }

  void count(const Step& step, double travelled) {
    if (!toolpath::moves(step)) return;
    ++result_.moves;
    fed_ += step.filament;
    const double fresh = std::max(0.0, fed_ - most_fed_);
    most_fed_ = std::max(most_fed_, fed_);
    result_.extruded += fresh;
    result_.primed += std::max(0.0, step.filament - fresh);
    if (step.kind != StepKind::print) result_.travel += travelled;
  }

  /// Where the gap is not known any more, or too small, along a path: up along the tool axis from where the
  /// tool comes to rest. An approach has retreated by itself.
  void end_early() {
    Stop& stop = result_.stop;
    if (gap_ && gap_->stop() != GapStop::none && stop.fault == machine::Fault::none) {
      const double retreat = approach_.retreat;
      const Stop failed = lift(retreat, gap_->filament_at(port_.now()));
      stop.why += failed ? fmt::format("; could not retreat: {}", failed.why)
                         : fmt::format("; retreated by {:.3f} mm", to_mm(retreat));
    }
    make_safe();
    stop.fault = port_.state().fault;
    if (stop.fault != machine::Fault::none) stop.status = Status::faulted;
  }

  /// A fault meets the machine where it is, behind what is planned.
  int line_of_stop() const {
    const int executed = result_.stop.fault == machine::Fault::none ? 0 : cycle_.line_executed();
    return executed > 0 ? executed : last_line_;
  }

  Stop lift(double height, double filament) {
    try {
      Stop braked = cycle_.abandon(filament);
      static_cast<void>(gap_->release());  // the tool rests where it was shifted to
      if (braked) return braked;
      Step up;
      up.kind = StepKind::travel;
      up.line = last_line_;
      up.X_WT = cycle_.resting_pose();
      up.X_WT.translation() += height * tool_axis(up.X_WT);
      if (Stop stop = cycle_.push(up)) return stop;
      return cycle_.come_to_rest();
    } catch (const InputError& error) {
      Stop stop;
      stop.status = Status::rejected;
      stop.why = error.what();
      return stop;
    }
  }

  /// Nothing moves on and nothing stays hot once the print has ended early. A port that is lost cannot obey.
  void make_safe() {
    static_cast<void>(port_.urgent(machine::UrgentCommand::stop));
    static_cast<void>(port_.set_outputs({}, port_.now() + kOutputPatience));
  }

  const toolpath::Program& program_;
  const machine::MachineDescription& machine_;
  machine::MachinePort& port_;
  const PrintOptions& options_;
  PrintObserver* observer_;
  const GapControllerOptions approach_;
  PrintedPart part_;
  std::unique_ptr<ContinuousGapController> gap_;
  ControlCycle cycle_;
  const double started_at_;
  machine::Outputs outputs_;
  PrintResult result_;
  Vec3 offset_;
  double fed_ = 0, most_fed_ = 0;  // [m]
  int last_line_ = 0;
};

}  // namespace

PrintResult print(const toolpath::Program& program, const machine::MachineDescription& machine,
                  machine::MachinePort& port, const PrintOptions& options, PrintObserver* observer) {
  return PrintLoop(program, machine, port, options, observer).run();
}

}  // namespace understudy::control
