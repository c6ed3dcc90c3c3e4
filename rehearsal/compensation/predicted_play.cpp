#include "rehearsal/compensation/predicted_play.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "control/compensation/command_map.h"
#include "control/motion/motion_planner.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::rehearsal {
namespace {

using kinematics::elements;
using toolpath::StepKind;

constexpr double kPlantStep = 2e-3;    // [s], the plant's own
constexpr double kSameShift = 0.2e-6;  // [m]; a tenth of what the compensated path keeps to
constexpr double kSameTurn = 2e-6;     // [rad]

class Prediction {
 public:
  Prediction(const toolpath::Program& program, const toolpath::RewrittenPath& path,
             const machine::MachineDescription& nominal, const machine::MachineDescription& known,
             const sim::AsBuilt& built)
      : program_(program),
        path_(path),
        mechanism_(nominal.make_mechanism()),
        planner_(*mechanism_, nominal.X_WB, control::motion_limits(nominal),
                 {nominal.X_WB * nominal.X_BT_home}, control::PoseCheck::solvable),
        map_(nominal, known),
        zero_(nominal.drive_zero()),
        stride_(std::max(1, static_cast<int>(std::lround(kPlantStep / nominal.cycle_time)))) {
    sim::QuasistaticOptions options;
    options.timestep = stride_ * nominal.cycle_time;
    plant_ = sim::make_quasistatic_plant(known, built, options);
    kinematics::AxisVector home{};
    static_cast<void>(mechanism_->inverse(nominal.X_BT_home, {}, home));
    command_ = command(home, {});
    plant_->reset(command_.position);
  }

  PlayPrediction run() {
    for (std::size_t i = 0; i < program_.steps.size(); ++i) {
      const toolpath::Step& step = program_.steps[i];
      if (step.kind == StepKind::end) break;
      stop_if_interrupted();
      // The machine waits here until the outputs are set.
      if (step.kind == StepKind::temperature || step.kind == StepKind::fan) planner_.finish();
      pushed_.push_back(i);
      planner_.push(step);
      drain();
    }
    planner_.finish();
    drain();
    if (count_ > 0) result_.tip_rms = std::sqrt(squares_ / static_cast<double>(count_));
    return std::move(result_);
  }

 private:
  sim::DriveCommand command(const kinematics::AxisVector& position, const kinematics::AxisVector& velocity) {
    sim::DriveCommand command;
    elements(command.position) = elements(position) - elements(zero_);
    command.velocity = velocity;
    return command;
  }

  void drain() {
    control::PlannedPoint point;
    while (planner_.next(point)) {
      if (++cycles_ % stride_ != 0) continue;
      plant_->step(command_);
      command_ = command(point.setpoint.position, point.setpoint.velocity);
      note(point);
    }
  }

  void note(const control::PlannedPoint& point) {
    Pose X_WT_without;
    if (map_.tool_at(point.setpoint.position, X_WT_without) != kinematics::SolveStatus::ok)
      throw MachineError("the calibrated machine cannot follow its drives");
    const Pose X_WT = plant_->tool_pose();
    const std::size_t step = pushed_[point.step];
    const toolpath::AskedPlace place = path_.place(step, point.fraction);
    Twist shift;
    shift << X_WT.translation() - X_WT_without.translation(),
        log_rotation(X_WT.linear() * X_WT_without.linear().transpose());
    result_.play.add(place, shift);
    if (program_.steps[step].kind != StepKind::print) return;
    const double square = (X_WT.translation() - path_.asked(place).translation()).squaredNorm();
    squares_ += square;
    ++count_;
    if (place.step >= result_.squares.size()) result_.squares.resize(place.step + 1);
    result_.squares[place.step] += square;
  }

  const toolpath::Program& program_;
  const toolpath::RewrittenPath& path_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  control::MotionPlanner planner_;
  control::CommandMap map_;
  kinematics::AxisVector zero_;
  int stride_;
  std::unique_ptr<sim::Plant> plant_;
  sim::DriveCommand command_;
  std::vector<std::size_t> pushed_;
  long cycles_ = 0;
  PlayPrediction result_;
  double squares_ = 0;
  std::uint64_t count_ = 0;
};

void take_found_play(const machine::MachineDescription& known, const kinematics::PerStrut<double>& found,
                     sim::AsBuilt& built) {
  const machine::Play& stated = known.hexapod().play;
  const double whole = stated.screw_nut + stated.ball_joint;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double total = std::max(0.0, found[i]);
    built.nut_play[i] = whole > 0 ? stated.screw_nut * total / whole : total;
    built.ball_play[i] = whole > 0 ? stated.ball_joint * total / whole : 0;
  }
}

}  // namespace

sim::AsBuilt known_machine(const machine::MachineDescription& known,
                           const machine::CalibratedParameters& parameters, PlayReference reference) {
  sim::AsBuilt built = sim::as_described(known);
  if (parameters.play) take_found_play(known, *parameters.play, built);
  if (reference == PlayReference::middle) return built;
  const kinematics::AxisVector gap = sim::QuasistaticSampler(known, built).gap();
  for (std::size_t i = 0; i < built.hexapod.length_offset.size(); ++i)
    built.hexapod.length_offset[i] -= gap[i];
  elements(built.axis_zero) -= elements(gap);
  return built;
}

void PlayAlongPath::add(const toolpath::AskedPlace& at, const Twist& shift) {
  const double place = static_cast<double>(at.step) + at.fraction;
  if (!places_.empty() && place <= last_place_) {  // at rest: what it comes to counts
    if (places_.back() == last_place_) shifts_.back() = shift;
    last_shift_ = shift;
    return;
  }
  const bool same = !places_.empty() && (shift.head<3>() - shifts_.back().head<3>()).norm() < kSameShift &&
                    (shift.tail<3>() - shifts_.back().tail<3>()).norm() < kSameTurn;
  if (!same) {
    if (!places_.empty() && places_.back() < last_place_) keep(last_place_, last_shift_);
    keep(place, shift);
  }
  last_place_ = place;
  last_shift_ = shift;
}

void PlayAlongPath::keep(double place, const Twist& shift) {
  places_.push_back(place);
  shifts_.push_back(shift);
}

Twist PlayAlongPath::at(std::size_t step, double fraction) const {
  if (places_.empty()) return Twist::Zero();
  const double place = static_cast<double>(step) + fraction;
  const auto next = std::ranges::upper_bound(places_, place);
  if (next == places_.begin()) return shifts_.front();
  const auto k = static_cast<std::size_t>(next - places_.begin());
  if (k == places_.size()) return shifts_.back();
  const double t = (place - places_[k - 1]) / (places_[k] - places_[k - 1]);
  return shifts_[k - 1] + t * (shifts_[k] - shifts_[k - 1]);
}

PlayPrediction predict_play(const toolpath::Program& program, const toolpath::RewrittenPath& path,
                            const machine::MachineDescription& nominal,
                            const machine::MachineDescription& known, const sim::AsBuilt& built) {
  return Prediction(program, path, nominal, known, built).run();
}

}  // namespace understudy::rehearsal
