#include "studies/gap/faulted_trial.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::studies {
namespace {

using control::GapControl;
using control::GapStop;
using rehearsal::TracePoint;
using rehearsal::TwinRun;

constexpr double kEndPath = 0.5e-3;  // [m], at the end of a bead: over it the gap is asked
/// [s], before the end of a bead: a controller may wait for 0.5 s and 1.5 mm without a good reading.
constexpr double kToAnswer = 0.8;
constexpr double kStepMin = 0.01e-3, kStepMax = 5e-3;  // [s]

rehearsal::RunOptions options_of(FaultedTask task) {
  rehearsal::RunOptions options;
  options.gap_control = task == FaultedTask::approach ? GapControl::start : GapControl::continuous;
  return options;
}

GapStop stop_of(const control::PrintResult& result) {
  if (result.completed) return GapStop::none;
  if (result.stop.gap != GapStop::none) return result.stop.gap;
  return result.stop.status == machine::Status::rejected ? GapStop::unreachable : GapStop::port_failed;
}

const control::GapOutcome* approach_of(const TwinRun& run) {
  return run.result.approaches.empty() ? nullptr : &run.result.approaches.front().outcome;
}

double least_gap(const TwinRun& run) {
  double least = std::numeric_limits<double>::infinity();
  for (const TracePoint& point : run.trace) least = std::min(least, point.gap);
  if (run.collision.nozzle_clearance_mm) least = std::min(least, from_mm(*run.collision.nozzle_clearance_mm));
  for (const sim::Contact& contact : run.collisions) least = std::min({least, 0.0, contact.clearance});
  return least;
}

double gap_at(const std::vector<TracePoint>& trace, double time) {
  const auto after =
      std::find_if(trace.begin(), trace.end(), [&](const TracePoint& p) { return p.time > time; });
  return after == trace.begin() ? std::nan("") : std::prev(after)->gap;
}

double gap_at_end(const std::vector<TracePoint>& trace) {
  double sum = 0;
  int points = 0;
  const double end = trace.empty() ? 0 : trace.back().path;
  for (const TracePoint& point : trace)
    if (point.extruding && point.path > end - kEndPath) sum += point.gap, ++points;
  return points > 0 ? sum / points : std::nan("");
}

double bead_end(const std::vector<TracePoint>& trace) {
  double end = 0;
  for (const TracePoint& point : trace)
    if (point.extruding) end = point.time;
  return end;
}

/// When what the controller last saw was exposed: what goes wrong with the machine later it cannot know.
double last_look(const TwinRun& run, FaultedTask task) {
  const control::GapOutcome* approach = approach_of(run);
  const bool approaches = task == FaultedTask::approach && approach && !approach->samples.empty();
  return approaches ? approach->samples.back().time : run.result.duration;
}

bool in_play(const FaultType& type, const InjectedFault& fault, const TwinRun& run, double looked_at) {
  if (type.camera) return run.altered_frames > 0;
  return !type.machine || fault.time < looked_at;
}

/// Too close is also right where it is true: whatever led the tool there.
Judgement judge_stop(const FaultType& type, GapStop stop, bool played, bool truly_close) {
  const bool names_it = std::find(type.right.begin(), type.right.end(), stop) != type.right.end();
  const bool is_true = stop == GapStop::too_close && truly_close;
  return played && !type.right.empty() && (names_it || is_true) ? Judgement::right : Judgement::wrong_reason;
}

Judgement judge_end(const machine::GapLimits& limits, double gap, bool played) {
  if (!(gap >= limits.accepted_min && gap <= limits.accepted_max)) return Judgement::not_found;
  return played ? Judgement::right : Judgement::not_in_play;
}

}  // namespace

PlantChoice plant_choice(const std::string& words) {
  const auto colon = words.find(':');
  PlantChoice plant{words.substr(0, colon), 0};
  const auto& engines = rehearsal::engine_names();
  if (std::find(engines.begin(), engines.end(), plant.engine) == engines.end())
    throw InputError(
        fmt::format("--plant {}: engine '{}': one of {}", words, plant.engine, fmt::join(engines, ", ")));
  if (colon == std::string::npos) return plant;
  double milliseconds = 0;
  const char* const end = words.data() + words.size();
  const auto read = std::from_chars(words.data() + colon + 1, end, milliseconds);
  plant.timestep = 1e-3 * milliseconds;
  if (read.ec != std::errc() || read.ptr != end ||
      !(plant.timestep >= kStepMin && plant.timestep <= kStepMax))
    throw InputError(fmt::format("--plant {}: the time step is {:g} to {:g} ms, as in mujoco:0.1", words,
                                 1e3 * kStepMin, 1e3 * kStepMax));
  return plant;
}

std::string to_string(const PlantChoice& plant) {
  return plant.timestep > 0 ? fmt::format("{}:{:g}", plant.engine, 1e3 * plant.timestep) : plant.engine;
}

const char* to_string(Judgement judgement) {
  switch (judgement) {
    case Judgement::right:
      return "right";
    case Judgement::not_in_play:
      return "not in play";
    case Judgement::wrong_reason:
      return "wrong reason";
    case Judgement::not_found:
      return "not found out";
    case Judgement::touched:
      return "touched";
  }
  return "unknown";
}

void judge(const FaultType& type, const InjectedFault& fault, FaultedTask task,
           const machine::GapLimits& limits, const TwinRun& run, FaultedTrial& trial) {
  const control::GapOutcome* approach = approach_of(run);
  const bool on_path = task == FaultedTask::print;
  const GapStop stop = on_path || !approach ? stop_of(run.result) : approach->stop;
  trial.stopped = stop != GapStop::none;
  trial.answer = trial.stopped ? to_string(stop) : on_path ? "completed" : "reached";
  if (trial.stopped) trial.why = run.result.stop.why;
  trial.least_gap = least_gap(run);
  const double looked_at = last_look(run, task);
  trial.last_gap = on_path ? gap_at_end(run.trace) : gap_at(run.trace, looked_at);
  trial.duration = run.result.duration;
  // A stop answers what has happened until then; who goes on can know what he saw.
  const bool played = in_play(type, fault, run, trial.stopped ? run.result.duration : looked_at);
  trial.judgement = trial.least_gap <= 0 ? Judgement::touched
                    : trial.stopped ? judge_stop(type, stop, played, trial.last_gap < limits.accepted_min)
                                    : judge_end(limits, trial.last_gap, played);
}

void prove_sound(FaultedTask task, FaultWorld& world) {
  const TwinRun run = rehearsal::run_twin(world.setup, options_of(task), {});
  FaultedTrial trial;
  judge(fault_types().front(), {}, task, world.setup.machine.gap, run, trial);
  if (trial.judgement != Judgement::right) {
    world.unsound = fmt::format("{}: {}, gap {:.3f} mm at the end, least {:.3f} mm{}{}",
                                to_string(trial.judgement), trial.answer, to_mm(trial.last_gap),
                                to_mm(trial.least_gap), trial.why.empty() ? "" : ": ", trial.why);
    return;
  }
  const control::GapApproach& approach = run.result.approaches.front();
  if (task == FaultedTask::approach) {
    world.window.begin = approach.outcome.samples.front().time;
    world.window.end = approach.outcome.samples.back().time;
  } else {
    world.window.begin = approach.done_at;
    world.window.end = std::max(world.window.begin, bead_end(run.trace) - kToAnswer);
  }
}

FaultedTrial run_faulted_trial(const FaultWorld& world, FaultedTask task, const FaultType& type,
                               const PlantChoice& plant, std::uint64_t seed, int number) {
  Random random(seed, fmt::format("faulted trial {}", number));
  const InjectedFault fault = draw_fault(type, world.window, world.setup.machine, random);
  rehearsal::TwinSetup setup = world.setup;
  setup.seed = random.bits();
  setup.engine = plant.engine;
  setup.timestep = plant.timestep;
  setup.camera_faults = fault.camera;
  setup.faults = fault.machine;
  FaultedTrial trial;
  trial.number = number;
  trial.world = world.seed;
  trial.surface = world.surface;
  trial.fault = type.name;
  trial.words = fault.words;
  try {
    judge(type, fault, task, setup.machine.gap, rehearsal::run_twin(setup, options_of(task), {}), trial);
  } catch (const MachineError& error) {
    trial.stopped = true;
    trial.answer = "engine failed";
    trial.why = error.what();
    trial.judgement = Judgement::wrong_reason;
  }
  return trial;
}

}  // namespace understudy::studies
