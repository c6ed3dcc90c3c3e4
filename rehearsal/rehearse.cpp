#include "rehearsal/rehearse.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "core/assert.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/units.h"
#include "core/version.h"
#include "machine/fixture_file.h"
#include "rehearsal/before_calibration.h"
#include "rehearsal/findings.h"
#include "rehearsal/fixture.h"
#include "rehearsal/process_check.h"
#include "rehearsal/rotary_words.h"
#include "rehearsal/run_twin.h"
#include "rehearsal/surface.h"
#include "sim/as_built/as_built_file.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace fs = std::filesystem;
namespace {

control::GapControl gap_control_of(const std::string& word, const machine::MachineDescription& machine) {
  if (word == "off" || (word.empty() && !machine.has_microscope)) return control::GapControl::off;
  if (word.empty() || word == "start" || word == "continuous") {
    if (machine.has_microscope)
      return word == "continuous" ? control::GapControl::continuous : control::GapControl::start;
    throw InputError(
        fmt::format("gap control '{}' needs a laser and a microscope; {} has none: off", word, machine.name));
  }
  throw InputError("gap control '" + word + "': one of off, start, continuous");
}

toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine) {
  toolpath::GcodeOptions gcode;
  gcode.X_WT_home = machine.X_WB * machine.X_BT_home;
  gcode.rotary = rotary_words(machine);
  if (dialect.extruder_letter != "E" && dialect.extruder_letter != "A")
    throw InputError("extruder letter '" + dialect.extruder_letter + "': one of E, A");
  gcode.extruder_letter = dialect.extruder_letter[0];
  for (int i = 0; i < 3; ++i) gcode.offset_W[i] = from_mm(dialect.place_mm[static_cast<std::size_t>(i)]);
  gcode.b_sign = dialect.b_sign;
  gcode.c_sign = dialect.c_sign;
  if (dialect.coordinates.empty()) return gcode;
  using Coordinates = toolpath::RotaryWords::Coordinates;
  const std::map<std::string, Coordinates> words{
      {"tip", Coordinates::tip}, {"machine", Coordinates::machine}, {"crossing", Coordinates::crossing}};
  const auto word = words.find(dialect.coordinates);
  if (word == words.end())
    throw InputError("coordinates '" + dialect.coordinates + "': one of tip, machine, crossing");
  if (!gcode.rotary)
    throw InputError("coordinates '" + dialect.coordinates + "': " + machine.name + " has no rotary words");
  gcode.rotary->coordinates = word->second;
  return gcode;
}

TwinSetup prepare(const RehearsalRequest& request) {
  const auto& engines = engine_names();
  if (std::find(engines.begin(), engines.end(), request.engine) == engines.end())
    throw InputError(fmt::format("unknown engine '{}': one of {}", request.engine, fmt::join(engines, ", ")));
  TwinSetup setup;
  setup.machine = machine::load_machine(request.machine);
  setup.program = toolpath::read_gcode(request.program, gcode_options(request.dialect, setup.machine));
  if (setup.machine.tool.prints()) {
    setup.material =
        machine::load_material(request.material.empty() ? setup.machine.process.material : request.material);
    check_process(setup.program, setup.machine, setup.material);
  }
  if (!request.fixture.empty())
    setup.part = read_fixture(machine::find_fixture(request.fixture), setup.machine);
  setup.as_built = sim::make_as_built(
      setup.machine, request.as_built.empty() ? sim::default_as_built(setup.machine) : request.as_built,
      request.seed);
  setup.engine = request.engine;
  setup.seed = request.seed;
  setup.faults = resolve_faults(request.faults, setup.machine);
  return setup;
}

Record describe_run(const RehearsalRequest& request, const TwinSetup& setup, control::GapControl mode) {
  Record record;
  record.program_name = fs::path(request.program).filename().string();
  record.machine_name = setup.machine.name;
  record.fixture_name = request.fixture.empty() ? "" : fs::path(request.fixture).filename().string();
  record.gap_control = mode == control::GapControl::off     ? "off"
                       : mode == control::GapControl::start ? "start"
                                                            : "continuous";
  record.as_built = sim::write_as_built(setup.as_built);
  record.machine_word = request.machine;
  record.place_mm = request.dialect.place_mm;
  record.measures_gap = setup.machine.has_microscope;
  record.title = record.program_name + " on " + record.machine_name;
  record.gap_accepted_min_mm = to_mm(setup.machine.gap.accepted_min);
  record.gap_accepted_max_mm = to_mm(setup.machine.gap.accepted_max);
  record.gap_aim_mm = to_mm(setup.machine.gap.aim);
  const auto mechanism = setup.machine.make_mechanism();
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    // The tip has columns x, y and z of its own.
    const std::string name = mechanism->axis_name(i);
    const bool taken = name == "x" || name == "y" || name == "z";
    AxisColumn column{(taken ? "axis_" : "") + name + (mechanism->axis_is_angle(i) ? "_deg" : "_mm"), {}, {}};
    const kinematics::AxisRange range = mechanism->axis_range(i);
    if (std::isfinite(range.lower)) column.min = range.lower;
    if (std::isfinite(range.upper)) column.max = range.upper;
    record.axes.push_back(column);
  }
  record.provenance = {kVersion,     setup.machine.sha256,  setup.program.sha256,
                       request.seed, setup.as_built.source, request.command};
  for (const sim::FaultEvent& event : setup.faults)
    record.provenance.faults.push_back(describe(event, setup.machine));
  return record;
}

/// Nothing where no gap exists: nothing was printed, or somewhere nothing lies below the nozzle.
std::optional<GapFigures> gap_of(const TwinRun& run, const TwinRun* without,
                                 const machine::MachineDescription& machine) {
  const auto& laid = run.deposition;
  if (!(laid.length > 0) || !std::isfinite(laid.gap_max) || !std::isfinite(laid.start_gap))
    return std::nullopt;
  GapFigures gap;
  gap.commanded_mm = to_mm(machine.gap.aim);
  if (without && without->deposition.length > 0 && std::isfinite(without->deposition.start_gap))
    gap.open_loop_start_mm = to_mm(without->deposition.start_gap);
  gap.start_mm = to_mm(laid.start_gap);
  gap.path_min_mm = to_mm(laid.gap_min);
  gap.path_mean_mm = to_mm(laid.gap_mean);
  gap.path_max_mm = to_mm(laid.gap_max);
  gap.in_band_fraction = laid.in_band_fraction;
  gap.frames = static_cast<int>(run.frames.size());
  return gap;
}

/// Volume of bead, told as length of the filament it came from.
double as_filament_mm(double volume, const machine::MachineDescription& machine) {
  if (!machine.tool.prints()) return 0;
  const double d = machine.tool.filament_diameter;
  return to_mm(volume / (0.25 * std::numbers::pi * d * d));
}

void fill_strands(const std::vector<sim::AirStrand>& strands, Record& record) {
  SagFigures sag;
  sag.strands = static_cast<int>(strands.size());
  for (const sim::AirStrand& strand : strands) {
    sag.max_um = std::max(sag.max_um, to_um(strand.sag));
    sag.unsupported_mm += to_mm(strand.length);
    record.strands.push_back({strand.line, strand.time, to_mm(strand.length), to_mm(strand.diameter),
                              to_mm(strand.speed), to_um(strand.sag), strand.solid_after, strand.duration,
                              strand.held_at_end, strand.solved, strand.small});
  }
  std::stable_sort(record.strands.begin(), record.strands.end(),
                   [](const StrandRow& a, const StrandRow& b) { return a.sag_um > b.sag_um; });
  record.sag = sag;
}

void fill_figures(const TwinRun& run, const TwinRun* without, const machine::MachineDescription& machine,
                  Record& record) {
  const auto& r = run.result;
  record.print = PrintFigures{r.duration, r.moves, to_mm(r.extruded),
                              as_filament_mm(run.deposition.deposited_volume, machine), to_mm(r.travel)};
  record.collision = run.collision;
  record.engine = run.engine;
  record.accuracy = run.accuracy;
  const auto& open_loop = without ? without->accuracy : run.accuracy;
  if (record.accuracy && open_loop) record.accuracy->open_loop_tip_max_um = open_loop->tip_max_um;
  if (machine.tool.prints()) fill_strands(run.strands, record);
  record.gap = gap_of(run, without, machine);
}

/// All at once: they share nothing that changes.
struct Runs {
  TwinRun main;
  std::optional<TwinRun> open_loop;  ///< where the main run has gap control
  std::optional<TwinRun> before;     ///< open-loop, driven by the description before its calibration
  const TwinRun* without() const { return open_loop ? &*open_loop : nullptr; }
};

Runs run_all(const TwinSetup& setup, control::GapControl mode, bool compare, const TwinSetup* before,
             const Progress& progress) {
  Runs runs;
  const RunOptions open_loop{control::GapControl::off, false};
  std::vector<std::function<void()>> jobs{[&] { runs.main = run_twin(setup, {mode, true}, progress); }};
  if (compare && mode != control::GapControl::off)
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
  scene.part = setup.part;
  scene.path = printed_path(setup.program);
  scene.printed = std::move(printed);
  return scene;
}

bool any_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::error; });
}

}  // namespace

Record rehearse(const RehearsalRequest& request, const Progress& progress) {
  const auto report = [&](double share, const std::string& what) {
    if (progress) progress(share, what);
  };
  report(0, "reading");
  const TwinSetup setup = prepare(request);
  std::optional<BeforeCalibration> before;
  if (!request.before.empty()) before = before_calibration(setup, request.before, request.machine);
  const SurfaceTask surface = prepare_surface(request.surface);
  const control::GapControl mode = gap_control_of(request.gap_control, setup.machine);
  Record record = describe_run(request, setup, mode);

  std::shared_ptr<const sim::Workpiece> printed;
  report(0.02, "checking limits");
  const auto constraints = control::check_constraints(setup.program, setup.machine);
  record.findings = findings_of(constraints);
  if (!any_error(record.findings)) {
    const Runs runs =
        run_all(setup, mode, request.compare_without_gap_control || before,
                before && before->not_run.empty() ? &before->setup : nullptr,
                [&](double share, const std::string& what) { report(0.05 + 0.85 * share, what); });
    const TwinRun* without = runs.without();
    fill_figures(runs.main, without, setup.machine, record);
    if (before) fill_comparison(*before, runs, record);
    auto findings = findings_of(runs.main, setup, mode);
    record.findings.insert(record.findings.end(), findings.begin(), findings.end());
    record.trace = runs.main.trace;
    record.trace_stride = runs.main.trace_stride;
    if (without) record.trace_without_gap_control = without->trace;
    record.frames = runs.main.frames;
    report(0.9, "measuring the surface");
    printed = runs.main.workpiece;
    study_surface(surface, *printed, record);
  }
  sort_findings(record.findings);
  record.go = !any_error(record.findings);
  if (request.keep_scene) record.scene = scene_of(setup, record.trace, printed);
  report(1, "done");
  return record;
}

}  // namespace understudy::rehearsal
