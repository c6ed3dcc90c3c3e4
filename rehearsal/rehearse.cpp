#include "rehearsal/rehearse.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "core/assert.h"
#include "core/error.h"
#include "core/file/file_cache.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/process/memory.h"
#include "core/units.h"
#include "core/version.h"
#include "machine/fixture_file.h"
#include "rehearsal/axis_columns.h"
#include "rehearsal/before_calibration.h"
#include "rehearsal/findings/accuracy_findings.h"
#include "rehearsal/findings/feature_findings.h"
#include "rehearsal/findings/findings.h"
#include "rehearsal/findings/machine_findings.h"
#include "rehearsal/findings/process_check.h"
#include "rehearsal/findings/start_block.h"
#include "rehearsal/gap_belief.h"
#include "rehearsal/library_versions.h"
#include "rehearsal/placement/placement.h"
#include "rehearsal/preparation.h"
#include "rehearsal/program/programmed_support.h"
#include "rehearsal/removal.h"
#include "rehearsal/request/input_digest.h"
#include "rehearsal/run_figures.h"
#include "rehearsal/run_twin.h"
#include "rehearsal/surface.h"
#include "sim/as_built/as_built_file.h"
#include "sim/removal/removal.h"

namespace understudy::rehearsal {
namespace fs = std::filesystem;
namespace {

Record describe_run(const RehearsalRequest& request, const TwinSetup& setup, control::GapControl mode) {
  Record record;
  record.program_name = fs::path(request.program).filename().string();
  record.machine_name = setup.machine.name;
  record.fixture_name = request.fixture.empty() ? "" : fs::path(request.fixture).filename().string();
  record.gap_control = mode == control::GapControl::off     ? "off"
                       : mode == control::GapControl::start ? "start"
                                                            : "continuous";
  record.as_built = sim::write_as_built(setup.as_built);
  record.program_word = request.program;
  record.machine_word = request.machine;
  record.place_mm = request.dialect.place_mm;
  record.measures_gap = setup.machine.has_microscope;
  record.title = record.program_name + " on " + record.machine_name;
  const sim::GapBand band = setup.layers ? setup.layers->typical_band() : sim::gap_band(setup.machine.gap);
  record.gap_accepted_min_mm = to_mm(band.low);
  record.gap_accepted_max_mm = to_mm(band.high);
  record.tip_tolerance_mm = to_mm(setup.accepted.tip);
  record.orientation_tolerance_deg = to_deg(setup.accepted.orientation);
  record.gap_aim_mm = to_mm(setup.machine.gap.aim);
  record.axes = axis_columns(*setup.machine.make_mechanism());
  record.provenance = {kVersion,     setup.machine.sha256,  setup.program.sha256,
                       request.seed, setup.as_built.source, request.command};
  record.provenance.inputs_sha256 = inputs_sha256(request, setup.program.sha256);
  if (!request.fixture.empty())
    record.provenance.fixture_sha256 = cached_sha256(machine::find_fixture(request.fixture));
  record.provenance.libraries = library_versions();
  for (const sim::FaultEvent& event : setup.faults)
    record.provenance.faults.push_back(describe(event, setup.machine));
  for (const sim::CameraFaultEvent& event : setup.camera_faults)
    record.provenance.faults.push_back(describe(event));
  return record;
}

/// All at once: they share nothing that changes.
struct Runs {
  TwinRun main;
  std::optional<TwinRun> open_loop;  ///< where the main run has gap control
  std::optional<TwinRun> before;     ///< open-loop, driven by the description before its calibration
  const TwinRun* without() const { return open_loop ? &*open_loop : nullptr; }
};

Runs run_all(const TwinSetup& setup, const RunOptions& options, bool compare, const TwinSetup* before,
             const Progress& progress) {
  Runs runs;
  const RunOptions open_loop{control::GapControl::off, false, options.beyond_limits, {}, nullptr};
  std::vector<std::function<void()>> jobs{[&] { runs.main = run_twin(setup, options, progress); }};
  if (compare && options.gap_control != control::GapControl::off)
    jobs.emplace_back([&] { runs.open_loop = run_twin(setup, open_loop, {}); });
  if (before) jobs.emplace_back([&] { runs.before = run_twin(*before, open_loop, {}); });
  in_parallel(jobs.size(), static_cast<int>(jobs.size()), [&](std::size_t n) { jobs[n](); });
  return runs;
}

void fill_comparison(const BeforeCalibration& before, const Runs& runs, Record& record) {
  const TwinRun* before_run = runs.before ? &*runs.before : nullptr;
  record.calibration = compare_calibrations(before, before_run, runs.open_loop ? *runs.open_loop : runs.main);
  record.provenance.machine_before_sha256 = before.setup.machine.sha256;
  if (before_run) record.trace_before_calibration = before_run->trace;
}

/// The middle of what is printed; nothing when nothing was simulated.
const TracePoint* middle_of_print(const std::vector<TracePoint>& trace) {
  const auto extruding = [](const TracePoint& p) { return p.extruding; };
  const auto first = std::find_if(trace.begin(), trace.end(), extruding);
  if (first == trace.end()) return trace.empty() ? nullptr : &trace.back();
  const auto last = std::find_if(trace.rbegin(), trace.rend(), extruding).base();
  return &*(first + (last - first) / 2);
}

sim::Configuration home_of(const machine::MachineDescription& machine) {
  sim::Configuration home{machine.X_WB * machine.X_BT_home, {}};
  const auto status = machine.make_mechanism()->inverse(machine.X_BT_home, {}, home.axes);
  UNDERSTUDY_ASSERT(status == kinematics::SolveStatus::ok || status == kinematics::SolveStatus::singular,
                    "the description's reader has settled that home can be reached");
  return home;
}

Scene scene_of(const TwinSetup& setup, const std::vector<TracePoint>& trace,
               std::shared_ptr<const sim::Workpiece> printed) {
  const TracePoint* point = middle_of_print(trace);
  Scene scene = machine_scene(setup.machine, setup.as_built,
                              point ? sim::Configuration{point->X_WT, point->axes} : home_of(setup.machine));
  scene.simulated = point != nullptr;
  scene.time = point ? point->time : 0;
  scene.part = setup.workblank ? setup.workblank->part : setup.built_part;
  constexpr std::size_t kMovesDrawn = 10'000;  // more than a picture shows
  scene.path = printed_path(setup.program, point ? point->line : 0, kMovesDrawn);
  scene.printed = std::move(printed);
  return scene;
}

constexpr std::size_t kProgramKept = 8'000'000;  // [bytes], twice what a page shows

Replay replay_of(const RehearsalRequest& request, const TwinSetup& setup,
                 const toolpath::FeatureTypes& features, const std::vector<TracePoint>& trace) {
  std::vector<Moment> moments;
  moments.reserve(trace.size());
  for (const TracePoint& point : trace) moments.push_back({point.time, {point.X_WT, point.axes}});
  Replay replay = make_replay(setup.machine, setup.as_built, moments);
  if (!request.program.empty()) {
    FileBeginning beginning = read_beginning(request.program, kProgramKept);
    replay.program = std::move(beginning.content);
    replay.program_left_out = beginning.left_out;
  }
  replay.features = features.changes();
  return replay;
}

bool any_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::error; });
}

/// Nothing where the program breaks limits so far that the engine fails: a finding says so.
std::optional<Runs> run_or_find(const RehearsalRequest& request, const TwinSetup& setup,
                                const std::optional<BeforeCalibration>& before, const RunOptions& options,
                                const Progress& progress, Record& record) {
  const bool runs_before = before && before->not_run.empty() && !options.beyond_limits;
  try {
    return run_all(setup, options, request.compare_without_gap_control || before,
                   runs_before ? &before->setup : nullptr,
                   [&](double share, const std::string& what) { progress(0.05 + 0.85 * share, what); });
  } catch (const MachineError& error) {
    if (!options.beyond_limits) {
      const std::string built = sim::file_of(setup.as_built);
      if (built.empty()) throw;
      throw MachineError(fmt::format("{}: the machine with these errors cannot be simulated to the end: {}",
                                     built, error.what()));
    }
    Finding f;
    f.kind = "unreachable";
    f.unit = "1";
    f.about = kStopped;
    f.message = fmt::format("beyond these limits it cannot be simulated: {}", error.what());
    record.findings.push_back(std::move(f));
    return std::nullopt;
  }
}

/// The controller's belief beside the truth that the record has by now.
void fill_beliefs(const TwinSetup& setup, control::GapControl mode, const control::PrintResult& result,
                  Record& record) {
  const GapKnowledge knowledge{setup.machine, setup.calibrated, mode, result};
  std::vector<CommandedInstant> instants;
  instants.reserve(record.trace.size());
  for (const TracePoint& point : record.trace)
    instants.push_back({point.time, point.extruding, point.X_WT_programmed});
  record.gap_beliefs = gap_beliefs(knowledge, instants);
  record.gap_belief_note = how_stated(knowledge);
  if (record.gap) fill_belief(record.trace, record.gap_beliefs, *record.gap);
}

/// What the runs say, on top of what the limits said. Their traces go into the record.
void fill(const TwinSetup& setup, const std::optional<BeforeCalibration>& before, const RunOptions& options,
          Runs& runs, Record& record) {
  const TwinRun* without = runs.without();
  fill_figures(runs.main, without, setup.truth, record);
  if (before) fill_comparison(*before, runs, record);
  for (const auto& findings :
       {findings_of(runs.main, setup, options.gap_control),
        setup.layers
            ? support_findings({setup.program, *setup.layers, setup.machine, setup.part}, runs.main.loose)
            : std::vector<Finding>{},
        setup.machine.tool.prints() && !setup.cure ? temperature_findings(setup.program, setup.material)
                                                   : std::vector<Finding>{},
        accuracy_findings(runs.main.tip_peak, runs.main.orientation_peak, setup.accepted)})
    record.findings.insert(record.findings.end(), findings.begin(), findings.end());
  record.trace = std::move(runs.main.trace);
  record.trace_stride = runs.main.trace_stride;
  record.curves = runs.main.curves;
  if (runs.open_loop) record.trace_without_gap_control = std::move(runs.open_loop->trace);
  record.frames = runs.main.frames;
  fill_beliefs(setup, options.gap_control, runs.main.result, record);
  if (runs.main.registration)
    record.registration = registration_figures(*runs.main.registration, *setup.registration);
}

/// The inputs are those that were asked for: the place follows from them.
void tell_placement(const RehearsalRequest& asked, const Placement& placement, Record& record) {
  record.provenance.inputs_sha256 = inputs_sha256(asked, record.provenance.program_sha256);
  const ProgramPlace& at = placement.place;
  record.placement = {{at.x_mm, at.y_mm, at.z_mm},
                      at.turn_deg,
                      at.spin_deg,
                      placement.margin,
                      placement.least,
                      placement.possible ? "" : placement.reason,
                      place_words(at)};
}

Finding no_place(const PlacementFigures& placement) {
  Finding finding;
  finding.kind = "placement";
  finding.value = placement.margin;
  finding.unit = "1";
  finding.message = "no place on the table holds every limit; at the best one " + placement.refused;
  return finding;
}

}  // namespace

Record rehearse(const RehearsalRequest& asked, const Progress& progress, RunListener* listener) {
  const Progress report = [&](double share, const std::string& what) {
    if (progress) progress(share, what);
  };
  std::optional<Placement> placement;
  if (asked.dialect.place_auto) placement = find_placement(asked, {}, progress);
  const RehearsalRequest request = placement ? placed(asked, placement->place) : asked;
  report(0, "reading");
  Mended mended;
  TwinSetup setup = prepare(request, mended);
  std::optional<BeforeCalibration> before;
  if (!request.before.empty()) before = before_calibration(setup, request.before, request.machine);
  const SurfaceTask surface = prepare_surface(request.surface);
  const control::GapControl mode = gap_control_of(request.gap_control, setup.machine);
  Record record = describe_run(request, setup, mode);
  if (placement) tell_placement(asked, *placement, record);

  report(0.02, "checking limits");
  record.findings = check_limits(request, setup, mended);
  for (const Finding& finding : machine_findings(machine::load_machine_notes(request.machine)))
    record.findings.push_back(finding);
  const RunOptions options{mode, true, any_error(record.findings), request.record, listener};
  if (options.beyond_limits) tell_how_simulated(record.findings);
  record.findings.insert(record.findings.begin(), mended.findings.begin(), mended.findings.end());
  record.passed_over = mended.passed_over;
  if (listener) listener->begins(record);
  return_free_memory();
  std::shared_ptr<const sim::Workpiece> printed;
  if (auto runs = run_or_find(request, setup, before, options, report, record)) {
    return_free_memory();  // of the observers, before the program is laid once more to see what it lies on
    fill(setup, before, options, *runs, record);
    report(0.9, "measuring the surface");
    printed = runs->main.workpiece;
    if (!setup.workblank) study_surface(surface, *printed, record);
    study_removal(runs->main, setup.accepted, record);
  }
  return_free_memory();
  if (record.placement && !record.placement->refused.empty())
    record.findings.push_back(no_place(*record.placement));
  tell_features(mended.features, record.findings);
  tell_start_block(mended.start_block_end, record.findings);
  sort_findings(record.findings);
  record.go = !any_error(record.findings);
  if (request.keep_scene) {
    record.scene = scene_of(setup, record.trace, printed);
    setup.program.steps = {};  // which are as large as all that was laid
    record.replay = replay_of(request, setup, mended.features, record.trace);
  }
  report(1, "done");
  return record;
}

}  // namespace understudy::rehearsal
