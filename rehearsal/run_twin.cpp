#include "rehearsal/run_twin.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/plant.h"
#include "sim/sensors/microscope.h"
#include "sim/twin/simulated_port.h"

namespace understudy::rehearsal {
namespace {

/// Keeps the truth beside the command, at every snapshot.
class TraceObserver : public sim::Observer {
 public:
  explicit TraceObserver(std::shared_ptr<const geometry::Mesh> part) : part_(std::move(part)) {}

  void observe(const sim::Snapshot& s) override {
    TracePoint point;
    point.time = s.time;
    point.line = s.line;
    point.extruding = !trace_.empty() && s.filament > filament_;
    point.X_WT = s.X_WT;
    point.X_WT_programmed = s.X_WT_commanded;
    point.gap = sim::true_gap(part_.get(), s.X_WT);
    point.axes = s.axes;
    if (point.extruding) path_ += (s.X_WT.translation() - trace_.back().X_WT.translation()).norm();
    point.path = path_;
    filament_ = std::max(filament_, s.filament);
    trace_.push_back(point);
  }

  std::vector<TracePoint> take() { return std::move(trace_); }

 private:
  std::shared_ptr<const geometry::Mesh> part_;
  std::vector<TracePoint> trace_;
  double filament_ = 0;
  double path_ = 0;
};

class ProgressRelay : public control::PrintObserver {
 public:
  explicit ProgressRelay(const Progress& progress) : progress_(progress) {}
  void progress(std::size_t done, std::size_t total, double) override {
    if (progress_)
      progress_(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total)), "printing");
  }

 private:
  const Progress& progress_;
};

/// The program's own pose: the command without the offset that the gap controller carries at that time.
void subtract_offsets(std::vector<TracePoint>& trace, const std::vector<control::OffsetChange>& offsets) {
  std::size_t next = 0;
  Vec3 offset = Vec3::Zero();
  for (TracePoint& point : trace) {
    while (next < offsets.size() && offsets[next].time <= point.time) offset = offsets[next++].offset_W;
    point.X_WT_programmed.translation() -= offset;
    point.tip_error = (point.X_WT.translation() - point.X_WT_programmed.translation()).norm();
    point.orientation_error = angle_between(point.X_WT.linear(), point.X_WT_programmed.linear());
  }
}

/// The truth of each exposure, kept apart from what the controller made of it.
struct ExposureTruth {
  double gap = 0;
  std::optional<Vec2> dot_px;
};

std::vector<FrameRecord> pair_with_truth(const control::PrintResult& result,
                                         const std::map<std::uint64_t, ExposureTruth>& truth) {
  std::vector<FrameRecord> frames;
  for (const auto& approach : result.approaches) {
    for (const auto& look : approach.outcome.looks) {
      FrameRecord record;
      record.look = look;
      if (const auto found = truth.find(look.frame.number); found != truth.end()) {
        record.true_gap = found->second.gap;
        record.true_dot_px = found->second.dot_px;
      }
      frames.push_back(std::move(record));
    }
  }
  return frames;
}

std::unique_ptr<sim::Plant> make_plant(const Stage& stage) {
  if (stage.engine == "mujoco") return sim::make_mujoco_plant(stage.machine, stage.as_built);
  if (stage.engine == "bullet") return sim::make_bullet_plant(stage.machine, stage.as_built);
  if (stage.engine == "quasistatic") return sim::make_quasistatic_plant(stage.machine, stage.as_built);
  throw InputError(
      fmt::format("unknown engine {}: one of {}", stage.engine, fmt::join(engine_names(), ", ")));
}

}  // namespace

const std::vector<std::string>& engine_names() {
  static const std::vector<std::string> names{"mujoco", "bullet", "quasistatic"};
  return names;
}

TwinRun run_twin(const Stage& stage, const RunOptions& options, const Progress& progress) {
  const auto started = std::chrono::steady_clock::now();
  const auto plant = make_plant(stage);
  std::optional<sim::Microscope> microscope;
  if (stage.machine.has_microscope) microscope.emplace(stage.machine, stage.part, stage.seed);
  std::map<std::uint64_t, ExposureTruth> truth;
  const auto expose = [&](const Pose& X_WT, const Region& region, std::uint64_t number) {
    truth[number] = {sim::true_gap(stage.part.get(), X_WT), microscope->true_dot(X_WT)};
    return microscope->expose(X_WT, region, number);
  };

  TraceObserver trace(stage.part);
  sim::DepositionObserver deposition(stage.machine, stage.part);
  sim::CollisionObserver collision(stage.machine, stage.as_built, stage.part, {});
  std::vector<sim::Observer*> observers{&trace, &deposition};
  if (options.watch_collisions) observers.push_back(&collision);
  sim::TwinOptions twin;
  twin.faults = stage.faults;
  sim::SimulatedPort port(stage.machine, *plant, microscope ? sim::Exposure(expose) : sim::Exposure(),
                          observers, twin);

  control::PrintOptions print_options;
  print_options.gap_control = options.gap_control;
  print_options.part = stage.part.get();
  ProgressRelay relay(progress);
  TwinRun run;
  run.result = control::print(stage.program, stage.machine, port, print_options, &relay);
  if (!port.engine_failure().empty()) throw MachineError(port.engine_failure());

  run.trace = trace.take();
  subtract_offsets(run.trace, run.result.offsets);
  run.frames = pair_with_truth(run.result, truth);
  run.deposition = deposition.summary();
  run.loose = deposition.loose_stretches();
  if (options.watch_collisions) {
    run.collisions = collision.collisions();
    run.near_collisions = collision.near_collisions();
    run.collision = {to_mm(collision.min_clearance()), collision.checks(), collision.pairs()};
  }
  const std::string engine = plant->engine();
  const auto space = engine.find(' ');
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  run.engine.name = engine.substr(0, space);
  run.engine.version = space == std::string::npos ? "" : engine.substr(space + 1);
  run.engine.timestep_s = plant->timestep();
  run.engine.steps = port.steps();
  run.engine.real_time_factor = plant->time() / wall.count();
  run.engine.closure_max_um = to_um(port.closure_max());
  return run;
}

}  // namespace understudy::rehearsal
