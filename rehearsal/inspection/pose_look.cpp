#include "rehearsal/inspection/pose_look.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/random.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/body_set.h"

namespace understudy::rehearsal {
namespace {

using kinematics::AxisVector;
using kinematics::Mechanism;
using kinematics::SolveStatus;

constexpr int kStarts = 200;
constexpr std::size_t kMostOthers = 15;
constexpr double kSameAngle = 1e-3, kSameLength = 1e-5;  // [rad], [m]: closer is the same branch
constexpr double kTurn = 2 * std::numbers::pi;

bool within_ranges(const Mechanism& mechanism, const AxisVector& axes) {
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    const auto range = mechanism.axis_range(i);
    const double q = axes[static_cast<std::size_t>(i)];
    if (q < range.lower || q > range.upper) return false;
  }
  return true;
}

/// Up to whole turns.
bool same(const Mechanism& mechanism, const AxisVector& a, const AxisVector& b) {
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    const double off = a[static_cast<std::size_t>(i)] - b[static_cast<std::size_t>(i)];
    const bool angle = mechanism.axis_is_angle(i);
    if (std::abs(angle ? std::remainder(off, kTurn) : off) > (angle ? kSameAngle : kSameLength)) return false;
  }
  return true;
}

/// Inverses from all over the ranges.
std::vector<AxisVector> other_branches(const Mechanism& mechanism, const Pose& X_BT,
                                       const AxisVector& taken) {
  std::vector<AxisVector> others;
  Random random(1, "branches");
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  for (int n = 0; n < kStarts && others.size() < kMostOthers; ++n) {
    AxisVector start{}, found{};
    for (std::size_t i = 0; i < count; ++i) {
      const auto range = mechanism.axis_range(static_cast<int>(i));
      const double reach = mechanism.axis_is_angle(static_cast<int>(i)) ? kTurn / 2 : 1;
      start[i] =
          random.uniform(std::max(range.lower, taken[i] - reach), std::min(range.upper, taken[i] + reach));
    }
    if (mechanism.inverse(X_BT, std::span(start).first(count), found) != SolveStatus::ok ||
        !within_ranges(mechanism, found) || same(mechanism, found, taken) ||
        std::ranges::any_of(others, [&](const AxisVector& other) { return same(mechanism, found, other); }))
      continue;
    others.push_back(found);
  }
  return others;
}

void measure_clearance(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> part,
                       PoseLook& look) {
  sim::BodySet bodies(machine, sim::as_described(machine), std::move(part), nullptr);
  for (const sim::BodyPair& pair : bodies.pairs()) {
    if (pair.printed) continue;
    const double distance = bodies.separation(pair, {look.X_WT, look.axes}, true).distance;
    std::optional<NearestPair>& least = pair.nozzle_at_work ? look.nozzle : look.nearest;
    if (!least || distance < least->distance)
      least = NearestPair{distance, bodies.name(pair.body), bodies.name(pair.obstacle)};
  }
}

PoseLook look_at(const machine::MachineDescription& machine, const Mechanism& mechanism, PoseLook look,
                 std::shared_ptr<const geometry::Mesh> part) {
  const Pose X_BT = machine.X_WB.inverse() * look.X_WT;
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  const bool solved = look.status == SolveStatus::ok;
  const std::span<const double> solution = std::span(look.axes).first(solved ? count : 0);
  mechanism.check(X_BT, solution, look.broken);
  if (!solved) return look;
  look.condition = mechanism.condition_number(X_BT, solution);
  look.others = other_branches(mechanism, X_BT, look.axes);
  measure_clearance(machine, std::move(part), look);
  return look;
}

}  // namespace

bool PoseLook::good() const {
  const auto apart = [](const std::optional<NearestPair>& pair) { return !pair || pair->distance > 0; };
  return status == SolveStatus::ok && broken.empty() && apart(nozzle) && apart(nearest);
}

PoseLook look_at_words(const machine::MachineDescription& machine, const std::string& words,
                       std::shared_ptr<const geometry::Mesh> part) {
  const auto mechanism = machine.make_mechanism();
  const toolpath::Program program = toolpath::parse_gcode(words.empty() ? "G28" : words + " G0", "pose",
                                                          control::gcode_options({}, machine));
  const toolpath::Step& step = program.steps.back();
  PoseLook look;
  look.X_WT = step.X_WT;
  const Pose X_BT = machine.X_WB.inverse() * step.X_WT;
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  look.status = mechanism->inverse(machine.X_BT_home, {}, look.axes);
  if (look.status == SolveStatus::ok && step.rotary) {
    AxisVector rates{};
    look.status = mechanism->axes_at_turns({X_BT.translation(), step.rotary->b, step.rotary->c}, {},
                                           std::span(look.axes).first(count), rates);
  } else {
    look.status = mechanism->inverse(X_BT, {}, look.axes);
  }
  return look_at(machine, *mechanism, std::move(look), std::move(part));
}

PoseLook look_at_axes(const machine::MachineDescription& machine, const AxisVector& axes,
                      std::shared_ptr<const geometry::Mesh> part) {
  const auto mechanism = machine.make_mechanism();
  PoseLook look;
  look.axes = axes;
  Pose X_BT = machine.X_BT_home;
  const SolveStatus status = mechanism->forward(
      std::span(axes).first(static_cast<std::size_t>(mechanism->axis_count())), machine.X_BT_home, X_BT);
  if (status != SolveStatus::ok)
    throw InputError(fmt::format("these axis positions make no pose: {}", to_string(status)));
  look.X_WT = machine.X_WB * X_BT;
  return look_at(machine, *mechanism, std::move(look), std::move(part));
}

}  // namespace understudy::rehearsal
