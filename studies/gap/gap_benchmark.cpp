#include "studies/gap/gap_benchmark.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "machine/model_files.h"
#include "rehearsal/rehearse.h"
#include "studies/gap/gap_bench.h"

namespace understudy::studies {
namespace {

using control::GapControl;
using control::GapStop;
using rehearsal::Finding;
using rehearsal::Record;
using rehearsal::RehearsalRequest;
using rehearsal::TracePoint;

constexpr int kFramesPerTrial = 10;    // of detectors
constexpr std::size_t kStations = 45;  // along the bottle's line: one in 0.25 mm

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  return {quantile(values, 0.5), quantile(values, 0.95)};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// Jobs, and what to call each.
class Jobs {
 public:
  void add(std::string what, std::function<void()> job) {
    jobs_.push_back({std::move(what), std::move(job)});
  }
  void run(int threads, const Progress& progress) const {
    in_parallel(
        jobs_.size(), threads, [this](std::size_t i) { jobs_[i].job(); },
        [&](std::size_t i, std::size_t done) {
          if (progress)
            progress(static_cast<double>(done) / static_cast<double>(jobs_.size()), jobs_[i].what);
        });
  }

 private:
  struct Job {
    std::string what;
    std::function<void()> job;
  };
  std::vector<Job> jobs_;
};

struct Cell {
  const machine::MachineDescription& machine;
  const GapSurface& surface;
  const GapCondition& condition;
  int trials;
  std::uint64_t seed;
};

/// Pictures around S at gaps that are controlled, the tip a little beside; both detectors on each.
std::vector<DetectorRow> measure_detectors(const Cell& cell) {
  const std::pair<const char*, decltype(&vision::measure_dot)> detectors[] = {
      {"centroid", &vision::measure_dot}, {"Gaussian fit", &vision::fit_dot}};
  std::vector<DetectorRow> rows;
  for (const auto& [name, measure] : detectors)
    rows.push_back({cell.surface.name, cell.condition.name, name, 0, 0, 0, 0, 0});
  GapScene scene(cell.machine, cell.surface, cell.condition, Since::always, cell.seed);
  Random random(cell.seed, "detectors " + cell.surface.name + cell.condition.name);
  const auto options = control::dot_options(cell.machine);
  std::vector<std::vector<double>> errors(rows.size());
  for (int i = 0; i < kFramesPerTrial * cell.trials; ++i) {
    stop_if_interrupted();
    Pose X_WT = cell.surface.X_WT_S;
    const Vec2 beside = uniform_vec2(random, 1e-3);
    X_WT.translation() += X_WT.linear() * Vec3(beside.x(), beside.y(), 0);
    const double target = random.uniform(0.08e-3, 0.25e-3);
    X_WT.translation() += (target - scene.true_gap(X_WT)) * tool_axis(X_WT);
    const auto surface = control::local_surface(*cell.surface.part, X_WT);
    const Image image =
        scene.expose(X_WT, control::region_for_gap(cell.machine, surface, target, 0.15e-3, 0.15e-3, 30));
    for (std::size_t d = 0; d < rows.size(); ++d) {
      const vision::DotMeasurement dot = detectors[d].second(image, options);
      control::GapReading reading;
      ++rows[d].frames;
      if (dot.status == vision::DotStatus::ok && control::read_gap(cell.machine, surface, dot, reading) &&
          control::whole(reading, dot))
        errors[d].push_back(to_um(reading.gap - scene.true_gap(X_WT)));
      else
        ++rows[d].missed;
    }
  }
  for (std::size_t d = 0; d < rows.size(); ++d) {
    rows[d].bias_um = mean_of(errors[d]);
    std::vector<double> distances;
    double squares = 0;
    for (const double e : errors[d]) {
      squares += std::pow(e - rows[d].bias_um, 2);
      distances.push_back(std::abs(e));
    }
    const auto n = static_cast<double>(errors[d].size());
    rows[d].sigma_um = n > 1 ? std::sqrt(squares / (n - 1)) : 0;
    rows[d].p95_um = spread_of(distances).p95;
  }
  return rows;
}

ApproachRow measure_approaches(const Cell& cell) {
  ApproachRow row{cell.surface.name, cell.condition.name, cell.condition.benign, 0, 0, 0, 0, {}, {}, {}};
  GapScene scene(cell.machine, cell.surface, cell.condition, Since::always, cell.seed);
  std::vector<double> errors, times;
  for (int i = 0; i < cell.trials; ++i) {
    stop_if_interrupted();
    const GapTrial trial =
        run_gap_trial(cell.machine, scene, GapControl::start, cell.seed + static_cast<std::uint64_t>(i));
    ++row.runs;
    row.touches += trial.gap_min_mm <= 0;
    if (trial.result.approaches.empty()) continue;
    const auto& approach = trial.result.approaches.front();
    if (approach.outcome.stop == GapStop::none) {
      ++row.reached;
      errors.push_back(1e3 * std::abs(trial.last_gap_mm - to_mm(cell.machine.gap.aim)));
      times.push_back(approach.done_at - approach.outcome.samples.front().time);
    } else {
      ++row.stops[to_string(approach.outcome.stop)];
      row.false_stops += cell.condition.benign;
    }
  }
  row.error_um = spread_of(errors);
  row.settle_s = spread_of(times);
  return row;
}

FollowingRow measure_followings(const Cell& cell) {
  FollowingRow row;
  row.surface = cell.surface.name;
  row.condition = cell.condition.name;
  row.benign = cell.condition.benign;
  // The approach is in good light: what is asked is how the path is followed.
  GapScene scene(cell.machine, cell.surface, cell.condition, Since::bead, cell.seed);
  std::vector<double> errors;
  int inside = 0, all = 0, frames = 0, used = 0;
  for (int i = 0; i < cell.trials; ++i) {
    stop_if_interrupted();
    const GapTrial trial =
        run_gap_trial(cell.machine, scene, GapControl::continuous, cell.seed + static_cast<std::uint64_t>(i));
    ++row.runs;
    row.touches += trial.gap_min_mm <= 0;
    row.completed += trial.result.completed;
    for (const double gap : trial.bead_gaps_mm) {
      ++all;
      inside += gap >= to_mm(cell.machine.gap.accepted_min) && gap <= to_mm(cell.machine.gap.accepted_max);
      errors.push_back(1e3 * std::abs(gap - to_mm(cell.machine.gap.aim)));
    }
    if (trial.result.following) {
      frames += trial.result.following->frames;
      used += trial.result.following->used;
    }
    if (trial.result.completed) continue;
    const bool on_path = trial.result.stopped_on_path();
    const GapStop seen = trial.result.stop.gap;
    const GapStop stop = seen == GapStop::none ? GapStop::port_failed : seen;
    ++row.stops[std::string(on_path ? "on the path: " : "approach: ") + to_string(stop)];
    row.false_stops += cell.condition.benign;
  }
  row.in_band_fraction = all ? static_cast<double>(inside) / all : 0;
  row.error_um = spread_of(errors);
  row.followed_fraction = frames ? static_cast<double>(used) / frames : 0;
  return row;
}

/// One machine with one mode.
struct BottleRun {
  bool printed = false, touched = false;
  std::vector<double> gaps_mm;
  double in_band = 0;
  std::string stop;
};

BottleRun print_bottle(const RehearsalRequest& request) {
  const Record record = rehearsal::rehearse(request);
  BottleRun run;
  run.touched =
      std::any_of(record.trace.begin(), record.trace.end(), [](const TracePoint& p) { return p.gap <= 0; }) ||
      std::any_of(record.findings.begin(), record.findings.end(),
                  [](const Finding& f) { return f.kind == "collision"; });
  int inside = 0;
  for (const TracePoint& p : record.trace) {
    if (!p.extruding) continue;
    const double gap = to_mm(p.gap);
    run.gaps_mm.push_back(gap);
    inside += gap >= record.gap_accepted_min_mm && gap <= record.gap_accepted_max_mm;
  }
  run.printed = !run.gaps_mm.empty();
  run.in_band = run.printed ? inside / static_cast<double>(run.gaps_mm.size()) : 0;
  for (const Finding& f : record.findings)
    if (f.message.starts_with("gap control stopped")) run.stop = f.message.substr(0, f.message.find(':'));
  return run;
}

/// A print that a stop has cut short has no place for its points.
std::vector<GapStation> gap_along(const std::vector<BottleRun>& runs) {
  std::vector<GapStation> along;
  for (std::size_t s = 0; s < kStations; ++s) {
    std::vector<double> here;
    for (const BottleRun& run : runs)
      if (run.printed && run.stop.empty())
        here.push_back(run.gaps_mm[(run.gaps_mm.size() - 1) * s / (kStations - 1)]);
    if (here.empty()) return {};
    along.push_back({quantile(here, 0.05), quantile(here, 0.5), quantile(here, 0.95)});
  }
  return along;
}

BottleRow bottle_row(const std::string& mode, const std::vector<BottleRun>& runs) {
  BottleRow row;
  row.mode = mode;
  row.in_band_worst = 1;
  std::vector<double> gaps;
  double inside = 0;
  for (const BottleRun& run : runs) {
    ++row.machines;
    row.touched += run.touched;
    if (!run.stop.empty()) ++row.stops[run.stop];
    if (!run.printed) continue;
    ++row.printed;
    row.kept += run.in_band >= 0.99;
    row.in_band_worst = std::min(row.in_band_worst, run.in_band);
    inside += run.in_band * static_cast<double>(run.gaps_mm.size());
    gaps.insert(gaps.end(), run.gaps_mm.begin(), run.gaps_mm.end());
  }
  if (gaps.empty()) return row;
  row.in_band_fraction = inside / static_cast<double>(gaps.size());
  row.gap_p01_mm = quantile(gaps, 0.01);
  row.gap_median_mm = quantile(gaps, 0.5);
  row.gap_p99_mm = quantile(gaps, 0.99);
  row.along = gap_along(runs);
  return row;
}

void require(const GapBenchmarkRequest& request) {
  const auto& known = gap_benchmark_parts();
  for (const std::string& part : request.parts)
    if (std::find(known.begin(), known.end(), part) == known.end())
      throw InputError(fmt::format("part '{}': one of {}", part, fmt::join(known, ", ")));
  if (request.trials < 1 || request.trials > 10'000)
    throw InputError(fmt::format("--trials {} is outside 1..10000", request.trials));
  if (request.machines < 1 || request.machines > 1'000'000)
    throw InputError(fmt::format("--machines {} is outside 1..1000000", request.machines));
  if (request.threads < 1 || request.threads > 1024)
    throw InputError(fmt::format("-j {} is outside 1..1024", request.threads));
}

}  // namespace

const std::vector<std::string>& gap_benchmark_parts() {
  static const std::vector<std::string> parts{"detectors", "approach", "following", "bottle"};
  return parts;
}

GapBenchmark run_gap_benchmark(const GapBenchmarkRequest& request, const Progress& progress) {
  require(request);
  const auto machine = machine::load_machine(request.machine);
  if (!machine.has_microscope)
    throw InputError("the gap benchmark needs a laser and a microscope; " + machine.name + " has none");
  GapBenchmark benchmark;
  benchmark.request = request;
  benchmark.machine_sha256 = machine.sha256;
  benchmark.aim_mm = to_mm(machine.gap.aim);
  benchmark.band_min_mm = to_mm(machine.gap.accepted_min);
  benchmark.band_max_mm = to_mm(machine.gap.accepted_max);
  const auto wants = [&](const char* part) {
    return std::find(request.parts.begin(), request.parts.end(), part) != request.parts.end();
  };
  const auto surfaces = gap_surfaces(machine, request.program);
  std::vector<Cell> cells;
  for (const GapSurface& surface : surfaces)
    for (const GapCondition& condition : gap_conditions())
      cells.push_back({machine, surface, condition, request.trials, request.seed});
  std::vector<std::vector<DetectorRow>> detectors(cells.size());
  std::vector<ApproachRow> approaches(cells.size());
  std::vector<FollowingRow> followings(cells.size());
  const std::vector<std::string> modes{"off", "start", "continuous"};
  std::vector<std::vector<BottleRun>> bottle(
      modes.size(), std::vector<BottleRun>(static_cast<std::size_t>(request.machines)));

  Jobs jobs;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string what = cells[i].surface.name + ", " + cells[i].condition.name;
    if (wants("detectors") && cells[i].condition.of_detectors)
      jobs.add(what, [&, i] { detectors[i] = measure_detectors(cells[i]); });
    if (wants("approach")) jobs.add(what, [&, i] { approaches[i] = measure_approaches(cells[i]); });
    if (wants("following")) jobs.add(what, [&, i] { followings[i] = measure_followings(cells[i]); });
  }
  if (wants("bottle"))
    for (std::size_t k = 0; k < bottle.front().size(); ++k)
      for (std::size_t m = 0; m < modes.size(); ++m)
        jobs.add(fmt::format("bottle, machine {}, {}", k + 1, modes[m]), [&, k, m] {
          RehearsalRequest one;
          one.program = request.program;
          one.machine = request.machine;
          one.fixture = "bottle";
          one.engine = "quasistatic";
          one.gap_control = modes[m];
          one.seed = request.seed + k;
          one.keep_scene = one.compare_without_gap_control = false;
          bottle[m][k] = print_bottle(one);
        });
  jobs.run(request.threads, progress);

  for (const auto& rows : detectors)
    benchmark.detectors.insert(benchmark.detectors.end(), rows.begin(), rows.end());
  if (wants("approach")) benchmark.approaches = approaches;
  if (wants("following")) benchmark.followings = followings;
  if (wants("bottle"))
    for (std::size_t m = 0; m < modes.size(); ++m)
      benchmark.bottle.push_back(bottle_row(modes[m], bottle[m]));
  return benchmark;
}

}  // namespace understudy::studies
