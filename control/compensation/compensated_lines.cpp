#include "control/compensation/compensated_lines.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "control/compensation/command_map.h"
#include "control/motion/motion_limits.h"
#include "control/motion/path_kinematics.h"
#include "core/error.h"

namespace understudy::control {
namespace {

using kinematics::SolveStatus;
using toolpath::Step;

/// [rad], by which the tool may lean otherwise than asked between two points of a line. The tip does not feel
/// it; a flat of 1 mm dips by 0.1 um.
constexpr double kTurnTolerance = 0.2e-3;

/// [m] of path between two looks at a line's way. A correction that sets in over 2 mm of it turns the way by
/// little between two of them.
constexpr double kLookTravel = 0.2e-3;
constexpr double kNoWay = 1e-9;  // [m]

/// One look at a line's way.
struct Sample {
  double share = 0;
  NominalCommand command;
};

Vec3 turns_of(const NominalCommand& command) { return {command.rotary->b, command.rotary->c, 0}; }

class Compensator {
 public:
  Compensator(const toolpath::Program& program, const std::vector<int>& lines, const CompensationTask& task)
      : program_(program),
        lines_(lines),
        task_(task),
        limits_(motion_limits(task.nominal)),
        mechanism_(task.nominal.make_mechanism()),
        path_(*mechanism_, task.nominal.X_WB),
        map_(task.nominal, task.known),
        X_WT_(task.nominal.X_WB * task.nominal.X_BT_home) {
    static_cast<void>(path_.axes(X_WT_, axes_));
    at_.command.X_WT = X_WT_;
  }

  toolpath::MovedLines run() {
    for (std::size_t i = 0; i < program_.steps.size();) {
      std::size_t last = i + 1;
      const int line = program_.steps[i].line;
      while (last < program_.steps.size() && program_.steps[last].line == line) ++last;
      if (std::ranges::binary_search(lines_, line))
        place(i, last, line);
      else
        leave(i, last);
      i = last;
    }
    return std::move(moved_);
  }

 private:
  PathSegment segment(std::size_t i) {
    const Step& step = program_.steps[i];
    PathSegment segment = path_.segment(step, X_WT_, axes_, limits_);
    if (const auto status = path_.axes_at(segment, segment.length, axes_); status != SolveStatus::ok)
      refuse(step.line, fmt::format("no axes of {} reach the pose at the end of this line: {}",
                                    task_.nominal.name, to_string(status)));
    return segment;
  }

  /// Lines that stay: what homes, and what a macro moves.
  void leave(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!toolpath::moves(program_.steps[i])) continue;
      static_cast<void>(segment(i));
      X_WT_ = program_.steps[i].X_WT;
      at_.command.X_WT = X_WT_;
      at_.command.rotary = program_.steps[i].rotary;
    }
  }

  void place(std::size_t first, std::size_t last, int line) {
    samples_.assign(1, {0, at_.command});
    double whole = 0;
    for (std::size_t i = first; i < last; ++i)
      if (toolpath::moves(program_.steps[i])) whole += look(i, whole);
    if (samples_.size() == 1) return;
    for (Sample& sample : samples_) sample.share = whole > 0 ? sample.share / whole : 1;
    samples_.back().share = 1;
    auto& pieces = moved_[line];
    for (std::size_t at = 0; at + 1 < samples_.size();) {
      at = farthest(at);
      const Sample& end = samples_[at];
      pieces.push_back({end.command.X_WT, end.command.rotary, end.share});
    }
    at_ = samples_.back();
  }

  /// Along a step whose way begins `before` [m] behind that of its line. Its length.
  double look(std::size_t i, double before) {
    const Step& step = program_.steps[i];
    const double speed = step.feed > 0 ? step.feed : limits_.travel_velocity;
    bend_max_ = kChordShare * corner_velocity_change(limits_) / speed;
    const PathSegment segment = this->segment(i);
    const int parts = segment.moves() ? parts_of(segment, kLookTravel, kCheckTurn) : 1;
    for (int k = 1; k <= parts; ++k) {
      const double fraction = static_cast<double>(k) / parts, s = fraction * segment.length;
      Pose X_WT = k == parts ? step.X_WT : path_.pose_at(segment, s);
      std::optional<toolpath::RotaryTurns> turns = step.rotary;
      if (segment.rotary && segment.moves()) turns = segment.turns_at(s);
      if (!step.rotary) turns.reset();
      if (task_.correction) correct(task_.correction(i, fraction), X_WT);
      samples_.push_back({before + s, {}});
      if (const auto status = map_.command(X_WT, turns, samples_.back().command); status != SolveStatus::ok)
        refuse(step.line,
               fmt::format("the calibrated {} does not reach ({:.3f}, {:.3f}, {:.3f}) mm: {}",
                           task_.known.name, 1e3 * X_WT.translation().x(), 1e3 * X_WT.translation().y(),
                           1e3 * X_WT.translation().z(), to_string(status)));
    }
    X_WT_ = step.X_WT;
    return segment.length;
  }

  static void correct(const Twist& by, Pose& X_WT) {
    X_WT.translation() += by.head<3>();
    X_WT.linear() = exp_rotation(by.tail<3>()) * X_WT.linear();
  }

  /// The last sample that one straight move from `at` may end at: it doubles its stride while it can.
  std::size_t farthest(std::size_t at) const {
    std::size_t good = at + 1, stride = 1;
    while (good + 1 < samples_.size()) {
      const std::size_t next = std::min(good + stride, samples_.size() - 1);
      if (straight(at, next)) {
        good = next;
        stride *= 2;
      } else if (stride == 1) {
        break;
      } else {
        stride = std::max<std::size_t>(1, stride / 4);
      }
    }
    return good;
  }

  Vec3 way(std::size_t to) const {
    return samples_[to].command.X_WT.translation() - samples_[to - 1].command.X_WT.translation();
  }

  /// A planner that rounds no corner brakes before one; and braking pushes plays about.
  bool bends(std::size_t from, std::size_t to) const {
    const Vec3 first = way(from + 1), last = way(to);
    if (first.norm() < kNoWay || last.norm() < kNoWay) return false;
    return std::atan2(first.cross(last).norm(), first.dot(last)) > bend_max_;
  }

  bool straight(std::size_t from, std::size_t to) const {
    if (bends(from, to)) return false;
    const Sample &a = samples_[from], &b = samples_[to];
    for (std::size_t k = from + 1; k < to; ++k) {
      const Sample& at = samples_[k];
      const double t = b.share > a.share ? (at.share - a.share) / (b.share - a.share) : 1;
      const Pose chord = interpolate(a.command.X_WT, b.command.X_WT, t);
      if ((chord.translation() - at.command.X_WT.translation()).norm() > task_.tolerance) return false;
      if (a.command.rotary && b.command.rotary && at.command.rotary) {
        const Vec3 turns = turns_of(a.command) + t * (turns_of(b.command) - turns_of(a.command));
        if ((turns - turns_of(at.command)).norm() > kTurnTolerance) return false;
      } else if (angle_between(chord.linear(), at.command.X_WT.linear()) > kTurnTolerance) {
        return false;
      }
    }
    return true;
  }

  [[noreturn]] void refuse(int line, const std::string& why) const {
    throw InputError(Place{program_.file, line}, why);
  }

  const toolpath::Program& program_;
  const std::vector<int>& lines_;
  const CompensationTask& task_;
  MotionLimits limits_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  PathKinematics path_;
  CommandMap map_;
  Pose X_WT_;  // where the original is
  kinematics::AxisVector axes_{};
  Sample at_;            // where the compensated program is
  double bend_max_ = 0;  // [rad], within a piece of this line
  std::vector<Sample> samples_;
  toolpath::MovedLines moved_;
};

}  // namespace

toolpath::MovedLines compensated_lines(const toolpath::Program& program, const std::vector<int>& lines,
                                       const CompensationTask& task) {
  return Compensator(program, lines, task).run();
}

}  // namespace understudy::control
