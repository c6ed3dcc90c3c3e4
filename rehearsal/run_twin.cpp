#include "rehearsal/run_twin.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"
#include "core/version.h"
#include "machine/record/recording_port.h"
#include "rehearsal/program/programmed_areas.h"
#include "sim/curing/curing.h"
#include "sim/deposition/bead_temperature.h"
#include "sim/plant/drive_errors.h"
#include "sim/plant/plant.h"
#include "sim/removal/removal.h"
#include "sim/sensors/microscope.h"
#include "sim/surface/beads_near.h"
#include "sim/twin/observer_thread.h"
#include "sim/twin/simulated_port.h"

namespace understudy::rehearsal {
namespace {

class Relay : public control::PrintObserver {
 public:
  Relay(const Progress& progress, sim::ObserverThread& observers, TraceObserver& trace)
      : progress_(progress), observers_(observers), trace_(trace) {}
  void progress(std::size_t done, std::size_t total, double) override {
    if (progress_)
      progress_(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total)), "printing");
  }
  void offset_changed(const control::OffsetChange& change) override {
    observers_.drain();
    trace_.add_offset(change);
  }

 private:
  const Progress& progress_;
  sim::ObserverThread& observers_;
  TraceObserver& trace_;
};

/// The truth of each exposure, kept apart from what the controller made of it.
struct ExposureTruth {
  double gap = 0;
  std::optional<Vec2> dot_px;
};

std::vector<FrameRecord> pair_with_truth(const control::PrintResult& result,
                                         const std::map<std::uint64_t, ExposureTruth>& truth) {
  std::vector<FrameRecord> frames;
  const auto add = [&](const control::GapSample& look) {
    FrameRecord record;
    record.look = look;
    if (const auto found = truth.find(look.frame.number); found != truth.end()) {
      record.true_gap = found->second.gap;
      record.true_dot_px = found->second.dot_px;
    }
    frames.push_back(std::move(record));
  };
  for (const auto& approach : result.approaches)
    for (const auto& look : approach.outcome.samples) add(look);
  if (result.following)
    for (const auto& look : result.following->samples) add(look);
  std::stable_sort(frames.begin(), frames.end(),
                   [](const FrameRecord& a, const FrameRecord& b) { return a.look.time < b.look.time; });
  return frames;
}

template <typename Options>
Options with_timestep(const TwinSetup& setup) {
  Options options;
  if (setup.timestep > 0) options.timestep = setup.timestep;
  return options;
}

std::unique_ptr<sim::Plant> make_engine(const TwinSetup& setup) {
  if (setup.engine == "mujoco")
    return sim::make_mujoco_plant(setup.truth, setup.as_built, with_timestep<sim::MujocoOptions>(setup));
  if (setup.engine == "bullet")
    return sim::make_bullet_plant(setup.truth, setup.as_built, with_timestep<sim::BulletOptions>(setup));
  if (setup.engine == "quasistatic")
    return sim::make_quasistatic_plant(setup.truth, setup.as_built,
                                       with_timestep<sim::QuasistaticOptions>(setup));
  throw InputError(
      fmt::format("unknown engine {}: one of {}", setup.engine, fmt::join(engine_names(), ", ")));
}

/// What the printed material knows of its own temperature.
sim::DepositionOptions deposition_options(const TwinSetup& setup,
                                          std::function<void(const sim::LaidBead&)> laid,
                                          sim::AirStrandSolver& strands) {
  sim::DepositionOptions options;
  options.laid = std::move(laid);
  if (setup.layers) options.band = [&layers = *setup.layers](int line) { return layers.band(line); };
  if (!setup.machine.tool.prints() || setup.cure) return options;  // resin carries what it holds
  options.on_unsupported = [&strands](const sim::UnsupportedStretch& stretch) { strands.add(stretch); };
  options.glass_transition = setup.material.glass_transition;
  options.substrate_temperature = sim::BeadTemperature(setup.truth, setup.material);
  return options;
}

constexpr double kLaserSees = 6e-3;  // [m], around the tip

/// Everything that watches a run, and what it watches.
struct Watch {
  explicit Watch(const TwinSetup& setup, const RunOptions& options)
      : workpiece(std::make_shared<sim::Workpiece>(setup.built_part, setup.as_built.table)),
        flow(setup.program, setup.machine),
        fill(workpiece, setup.machine, programmed_areas(setup.program, setup.truth)),
        strands(setup.truth, setup.material),
        deposition(setup.truth, workpiece, options_of(setup)),
        curing(curing_of(setup)),
        trace(deposition, TraceObserver::kCapacity, setup.asked),
        collision(setup.truth, setup.as_built, setup.workblank ? setup.workblank->stock : setup.built_part,
                  collision_options(setup)),
        curves(deposition, options.watch_collisions ? &collision : nullptr, struts_of(setup)),
        removal(removal_of(setup)),  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): a unique_ptr holds it
        thread(watching(options)) {}

  std::vector<sim::Observer*> watching(const RunOptions& options) {
    std::vector<sim::Observer*> all{curing ? static_cast<sim::Observer*>(&*curing) : &deposition, &trace};
    if (options.watch_collisions) all.push_back(&collision);
    if (removal) all.push_back(removal.get());
    all.push_back(&curves);
    return all;
  }

  static int struts_of(const TwinSetup& setup) {
    return setup.machine.is_chain() ? 0 : static_cast<int>(kinematics::kStruts);
  }

  static std::unique_ptr<sim::RemovalObserver> removal_of(const TwinSetup& setup) {
    return setup.workblank ? std::make_unique<sim::RemovalObserver>(*setup.workblank) : nullptr;
  }

  sim::DepositionOptions options_of(const TwinSetup& setup) {
    auto options = deposition_options(
        setup, [this](const auto& bead) { laid(bead); }, strands);
    // What lies deeper than the light reaches is not held by what is below.
    if (setup.cure)
      options.band = [this, limits = setup.machine.gap](int) {
        return sim::GapBand{limits.accepted_min, std::min(limits.accepted_max, curing->depth()), 0};
      };
    return options;
  }

  std::optional<sim::CuringObserver> curing_of(const TwinSetup& setup) {
    if (!setup.cure) return std::nullopt;
    const double diameter = setup.truth.tool.filament_diameter;
    return std::make_optional<sim::CuringObserver>(
        *setup.cure, std::numbers::pi / 4 * diameter * diameter, [this] { return deposition.gap(); },
        deposition);
  }

  void laid(const sim::LaidBead& bead) {
    flow.add(bead);
    fill.add(bead, deposition.fresh_from());
  }

  sim::CollisionOptions collision_options(const TwinSetup& setup) const {
    sim::CollisionOptions options;
    if (setup.layers) options.bead_press = setup.layers->typical_band().soft_depth;
    options.beads = &workpiece->beads();
    if (setup.workblank) options.cutter = sim::cutter_of(setup.truth.tool);
    options.fresh_from = [this] { return deposition.fresh_from(); };
    return options;
  }

  /// True gap at a pose, over what has been printed by now.
  double gap(const Pose& X_WT) const {
    const auto below = workpiece->below(X_WT, deposition.fresh_from());
    return below ? below->distance : std::numeric_limits<double>::infinity();
  }

  std::shared_ptr<sim::Workpiece> workpiece;
  FlowWatch flow;
  FillWatch fill;
  sim::AirStrandSolver strands;
  sim::DepositionObserver deposition;
  std::optional<sim::CuringObserver> curing;
  TraceObserver trace;
  sim::CollisionObserver collision;
  CurvesObserver curves;
  std::unique_ptr<sim::RemovalObserver> removal;
  sim::ObserverThread thread;
};

/// Nothing is printed on a part that was not found.
control::PrintResult not_printed(const RegistrationRun& registration) {
  control::PrintResult result;
  result.stop.status = machine::Status::rejected;
  result.stop.why = registration.found.stop ? registration.found.stop.why : registration.found.refused;
  return result;
}

EngineFigures engine_of(const sim::Plant& plant, const sim::SimulatedPort& port) {
  const std::string engine = plant.engine();
  const auto space = engine.find(' ');
  EngineFigures figures;
  figures.name = engine.substr(0, space);
  figures.version = space == std::string::npos ? "" : engine.substr(space + 1);
  figures.timestep_s = plant.timestep();
  figures.steps = port.steps();
  figures.closure_max_um = to_um(port.closure_max());
  return figures;
}

CollisionFigures collision_figures(const sim::CollisionObserver& collision) {
  const auto in_mm = [](double clearance) {
    return std::isfinite(clearance) ? std::optional(to_mm(clearance)) : std::nullopt;
  };
  CollisionFigures figures;
  figures.min_clearance_mm = in_mm(collision.min_clearance());
  if (figures.min_clearance_mm)
    figures.closest = collision.closest().body + " and " + collision.closest().obstacle;
  figures.nozzle_clearance_mm = in_mm(collision.min_nozzle_clearance());
  figures.checks = collision.checks();
  figures.pairs = collision.pairs();
  return figures;
}

/// What the observers of a print that has ended saw.
void take_results(const TwinSetup& setup, const RunOptions& options, Watch& watch, TwinRun& run) {
  run.accuracy = watch.trace.accuracy();
  run.tip_peak = watch.trace.tip_peak();
  run.orientation_peak = watch.trace.orientation_peak();
  run.trace_stride = watch.trace.stride();
  run.trace = watch.trace.take();
  run.curves = watch.curves.take();
  if (setup.machine.tool.prints() && !setup.cure)
    run.curves.glass_transition = setup.material.glass_transition;
  run.deposition = watch.deposition.summary();
  run.loose = watch.deposition.unsupported_stretches();
  run.flow = watch.flow.stretches();
  run.fill = watch.fill.figures();
  run.workpiece = watch.workpiece;
  run.strands = watch.strands.finish();
  if (watch.removal) {
    run.removal = watch.removal->summary();
    run.milled = std::make_shared<sim::MilledSurface>(watch.removal->surface());
  }
  if (options.watch_collisions) {
    run.collisions = watch.collision.collisions();
    run.near_collisions = watch.collision.near_collisions();
    run.collision = collision_figures(watch.collision);
  }
}

sim::TwinOptions twin_options(const TwinSetup& setup, const RunOptions& options) {
  sim::TwinOptions twin;
  twin.faults = setup.faults;
  twin.camera_faults = setup.camera_faults;
  twin.seed = setup.seed;
  twin.nozzle_offset = setup.as_built.nozzle_offset;
  twin.hold_at_limits = options.beyond_limits;
  if (!setup.machine.file.empty())
    twin.load_encoders.emplace(setup.truth, setup.as_built,
                               machine::load_encoder_counts(setup.machine.file.string()));
  return twin;
}

void note_inputs(const TwinSetup& setup, machine::RecordWriter& writer) {
  writer.note(fmt::format("version {}", kVersion));
  writer.note("program " + setup.program.file);
  writer.note("program_sha256 " + setup.program.sha256);
  writer.note("machine_sha256 " + setup.machine.sha256);
  writer.note("port twin://" + setup.engine);
}

}  // namespace

std::unique_ptr<sim::Plant> make_plant(const TwinSetup& setup) {
  return sim::with_drive_errors(make_engine(setup), setup.truth, setup.as_built);
}

TwinRun run_twin(const TwinSetup& setup, const RunOptions& options, const Progress& progress) {
  const auto started = std::chrono::steady_clock::now();
  const auto plant = make_plant(setup);
  Watch watch(setup, options);
  if (RunListener* listener = options.listener)
    watch.trace.on_point([listener](const TracePoint& newest) { listener->moved(newest); });
  std::optional<sim::Microscope> microscope;
  if (setup.truth.has_microscope) {
    sim::MicroscopeOptions view;
    view.table = setup.as_built.table;
    microscope.emplace(setup.truth, setup.built_part, setup.seed, view);
  }
  std::map<std::uint64_t, ExposureTruth> truth;
  const auto expose = [&](const sim::Shot& shot) {
    watch.thread.drain();                  // the laser sees what has been printed by now
    const Pose X_WT = plant->tool_pose();  // the shot may be one that only a faulty camera shows
    microscope->set_printed(sim::beads_near(watch.workpiece->beads(), shot.X_WT.translation(), kLaserSees));
    truth[shot.number] = {watch.gap(X_WT), microscope->true_dot(X_WT)};
    return microscope->expose(shot);
  };
  sim::SimulatedPort port(setup.machine, *plant, microscope ? sim::Exposure(expose) : sim::Exposure(),
                          {&watch.thread}, twin_options(setup, options));

  std::optional<machine::RecordWriter> writer;
  std::optional<machine::RecordingPort> recorded;
  if (!options.record.empty()) {
    writer.emplace(options.record, port.axis_count());
    recorded.emplace(port, *writer);
    note_inputs(setup, *writer);
  }
  machine::MachinePort& seen = recorded ? static_cast<machine::MachinePort&>(*recorded) : port;

  control::PrintOptions print_options;
  print_options.gap_control = options.gap_control;
  if (options.beyond_limits) print_options.poses = control::PoseCheck::solvable;
  print_options.part = setup.part.get();
  Relay relay(progress, watch.thread, watch.trace);
  TwinRun run;
  const toolpath::Program* program = &setup.program;
  if (setup.registration) {
    if (progress) progress(0, "registering the part");
    const auto true_gap = [&](std::uint64_t exposure) {
      const auto found = truth.find(exposure);
      return found == truth.end() ? std::nullopt : std::optional(found->second.gap);
    };
    run.registration = run_registration(*setup.registration, setup.program, setup.machine, seen, true_gap,
                                        !options.beyond_limits);
    program = &run.registration->program;
    print_options.part = run.registration->part.get();
  }
  run.result = run.registration && !run.registration->good()
                   ? not_printed(*run.registration)
                   : control::print(*program, setup.machine, seen, print_options, &relay);
  watch.thread.drain();
  if (!port.engine_failure().empty()) throw MachineError(port.engine_failure());
  watch.deposition.finish();

  take_results(setup, options, watch, run);
  run.frames = pair_with_truth(run.result, truth);
  run.altered_frames = port.altered_frames();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  run.engine = engine_of(*plant, port);
  run.timing = {plant->time(), wall.count(), port.first_setpoint_at()};
  return run;
}

}  // namespace understudy::rehearsal
