#include "control/resume/resumed_program.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "control/approach.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::control {

using toolpath::Program;
using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kAbove[] = {10e-3, 20e-3, 40e-3};  // [m]
constexpr double kClear = 5e-3;                     // [m], of the tip
constexpr double kSample = 1e-3;                    // [m]
constexpr double kPrimeFeed = 1e-3;                 // [m/s], of filament
constexpr double kWhole = 1e-9;                     // share of a step that is rounding

Pose pose_at(const Pose& from, const Pose& to, double share) {
  Pose X = Pose::Identity();
  X.translation() = from.translation() + share * (to.translation() - from.translation());
  X.linear() = Quat(from.linear()).slerp(share, Quat(to.linear())).toRotationMatrix();
  return X;
}

/// Calls `visit` with points a millimetre apart on the straight way; false as soon as it says so.
template <typename Visit>
bool along(const Vec3& from, const Vec3& to, const Visit& visit) {
  const int parts = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kSample)));
  for (int i = 0; i <= parts; ++i)
    if (!visit(Vec3(from + (to - from) * (static_cast<double>(i) / parts)))) return false;
  return true;
}

std::vector<Vec3> laid_points(const Program& whole, const Pose& home, const Restart& restart) {
  std::vector<Vec3> points;
  Pose before = home;
  for (std::size_t i = 0; i <= restart.step; ++i) {
    const Step& step = whole.steps[i];
    if (!toolpath::moves(step)) continue;
    const double share = i < restart.step ? 1 : restart.done;
    if (step.kind == StepKind::print && share > 0)
      along(before.translation(), pose_at(before, step.X_WT, share).translation(), [&](const Vec3& p) {
        points.push_back(p);
        return true;
      });
    before = step.X_WT;
  }
  return points;
}

bool way_is_clear(const Vec3& from, const Vec3& to, const geometry::Mesh* part,
                  const std::vector<Vec3>& laid) {
  return along(from, to, [&](const Vec3& p) {
    if (part != nullptr && part->signed_distance(p) < kClear) return false;
    return std::ranges::none_of(laid, [&](const Vec3& bead) { return (bead - p).norm() < kClear; });
  });
}

Step travel_to(const Pose& X_WT, int line) {
  Step step;
  step.kind = StepKind::travel;
  step.X_WT = X_WT;
  step.line = line;
  return step;
}

/// Of what the program set before a step: as it was last.
void set_as_before(const Program& whole, std::size_t step, Program& rest) {
  for (const StepKind kind : {StepKind::temperature, StepKind::fan}) {
    for (std::size_t i = step; i-- > 0;) {
      if (whole.steps[i].kind != kind) continue;
      rest.steps.push_back(whole.steps[i]);
      break;
    }
  }
}

std::size_t approach_before(const Program& whole, std::size_t step) {
  for (std::size_t i = step; i-- > 0;) {
    if (!toolpath::moves(whole.steps[i])) continue;
    if (is_approach(whole, i)) return i;
    if (whole.steps[i].filament == 0) break;
  }
  return step;
}

}  // namespace

ResumedProgram resumed_program(const Program& whole, const machine::MachineDescription& machine,
                               const geometry::Mesh* part, const Restart& restart) {
  if (std::ranges::any_of(whole.steps, [](const Step& s) { return s.rotary.has_value(); }))
    throw InputError(whole.file + ": a program of rotary words is not resumed");
  const Pose home = machine.X_WB * machine.X_BT_home;
  const Step& cut = whole.steps[restart.step];
  const Pose begin = pose_at(pose_before(whole, restart.step, home), cut.X_WT, restart.done);
  // A bead that was not begun is approached as it is in the whole program, and measured.
  const std::size_t first = restart.done > 0 ? restart.step : approach_before(whole, restart.step);
  const Pose arrival = first < restart.step ? pose_before(whole, first, home) : begin;

  const std::vector<Vec3> laid = laid_points(whole, home, restart);
  const auto* above = std::ranges::find_if(kAbove, [&](double height) {
    const Vec3 p = arrival.translation() + height * tool_axis(arrival);
    return way_is_clear(home.translation(), p, part, laid);
  });
  if (above == std::end(kAbove))
    throw InputError({whole.file, cut.line},
                     fmt::format("no way from home to above this line keeps the tip {:.0f} mm from the part: "
                                 "it is not resumed",
                                 to_mm(kClear)));

  ResumedProgram resumed;
  Program& rest = resumed.program;
  rest.file = whole.file;
  rest.sha256 = whole.sha256;
  set_as_before(whole, restart.step, rest);
  Pose high = arrival;
  high.translation() += *above * tool_axis(arrival);
  rest.steps.push_back(travel_to(high, 0));
  rest.steps.push_back(travel_to(arrival, 0));
  if (restart.prime > 0) {
    Step prime = travel_to(arrival, 0);
    prime.kind = StepKind::move;
    prime.feed = kPrimeFeed;
    prime.filament = restart.prime;
    rest.steps.push_back(prime);
  }
  for (std::size_t i = first; i < restart.step; ++i) {
    Step step = whole.steps[i];
    if (!toolpath::moves(step) || !is_approach(whole, i)) continue;
    step.filament = 0;
    rest.steps.push_back(step);
  }
  resumed.kept = rest.steps.size();
  rest.steps.insert(rest.steps.end(), whole.steps.begin() + static_cast<std::ptrdiff_t>(restart.step),
                    whole.steps.end());
  Step& rest_of_cut = rest.steps[resumed.kept];
  rest_of_cut.filament *= 1 - restart.done;
  rest_of_cut.duration *= 1 - restart.done;
  return resumed;
}

namespace {

/// A print step and how much of it is laid, by the filament fed.
struct Place {
  std::size_t step = 0;
  double done = 0, begin = 0;  ///< [m], filament where the step begins
};

std::optional<Place> place_of(const Program& program, int line, double fed) {
  std::optional<Place> place;
  double begin = 0;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const Step& step = program.steps[i];
    if (step.line == line && fed >= begin && lays_bead(program, i))
      place = Place{i, std::min(1.0, (fed - begin) / step.filament), begin};
    if (toolpath::moves(step)) begin += step.filament;
  }
  return place;
}

Vec3 tip_of(const machine::MachineDescription& machine, const machine::AxisVector& axes, const Pose& near) {
  const auto mechanism = machine.make_mechanism();
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  Pose X_BT;
  const auto solved =
      mechanism->forward(std::span<const double>(axes.data(), count), machine.X_WB.inverse() * near, X_BT);
  return solved == kinematics::SolveStatus::ok ? Vec3((machine.X_WB * X_BT).translation())
                                               : Vec3(near.translation());
}

}  // namespace

Restart restart_after(const CutRecord& cut, const std::string& file, const Program& whole,
                      const machine::MachineDescription& machine, const geometry::Mesh* part,
                      const std::optional<Restart>& begun) {
  ResumedProgram session{whole, 0};
  if (begun) session = resumed_program(whole, machine, part, *begun);
  const LaidFilament& laid = cut.laid;
  const auto place = laid.any ? place_of(session.program, laid.line, laid.fed) : std::nullopt;
  if (!place) {
    if (!begun)
      throw InputError({file}, "it was cut before the first bead: print the program from its beginning");
    Restart again = *begun;
    again.prime -= std::min(again.prime, laid.fed_at_rest);
    return again;
  }
  Restart restart;
  const std::vector<Step>& steps = session.program.steps;
  const Pose home = machine.X_WB * machine.X_BT_home;
  const double at_setpoint =
      std::clamp((laid.fed_at_setpoint - place->begin) / steps[place->step].filament, 0.0, 1.0);
  const Pose programmed =
      pose_at(pose_before(session.program, place->step, home), steps[place->step].X_WT, at_setpoint);
  restart.offset_W = tip_of(machine, laid.axes, programmed) - programmed.translation();
  std::size_t step = place->step;
  double done = place->done, target = laid.fed;
  if (laid.ended || done > 1 - kWhole) {
    target = place->begin + steps[step].filament;
    std::size_t index = step + 1;
    while (index < steps.size() && !lays_bead(session.program, index)) ++index;
    if (index == steps.size()) throw InputError({file}, "all its beads are laid: nothing is left to print");
    for (std::size_t i = step + 1; i < index; ++i)
      if (toolpath::moves(steps[i])) target += steps[i].filament;
    step = index;
    done = 0;
  }
  restart.prime = std::max(0.0, target - laid.fed_at_rest);
  if (restart.prime < kWhole) restart.prime = 0;
  restart.step = begun ? begun->step + (step - session.kept) : step;
  restart.done = begun && step == session.kept ? begun->done + (1 - begun->done) * done : done;
  return restart;
}

std::string restart_words(const Restart& r) {
  return fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", r.step, r.done, r.prime, r.offset_W.x(),
                     r.offset_W.y(), r.offset_W.z());
}

std::optional<Restart> restart_of_words(const std::string& words, const Program& whole) {
  Restart r;
  std::istringstream in(words);
  if (!(in >> r.step >> r.done >> r.prime >> r.offset_W.x() >> r.offset_W.y() >> r.offset_W.z()))
    return std::nullopt;
  const bool good = r.step < whole.steps.size() && lays_bead(whole, r.step) && r.done >= 0 && r.done < 1 &&
                    r.prime >= 0 && r.offset_W.allFinite();
  return good ? std::optional(r) : std::nullopt;
}

}  // namespace understudy::control
