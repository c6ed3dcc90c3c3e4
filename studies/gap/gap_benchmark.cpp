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
#include "studies/gap/bottle_prints.h"
#include "studies/gap/gap_bench.h"

namespace understudy::studies {
namespace {

using control::GapControl;
using control::GapStop;

constexpr int kFramesPerTrial = 10;  // of detectors

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

FaultedTwinRequest faulted_request(const GapBenchmarkRequest& request, FaultedTask task) {
  FaultedTwinRequest faulted;
  faulted.machine = request.machine;
  faulted.program = request.program;
  faulted.task = task;
  faulted.faults = request.faults;
  faulted.trials = request.trials;
  faulted.worlds = request.machines;
  faulted.seed = request.seed;
  faulted.plants = request.plants;
  faulted.threads = request.threads;
  return faulted;
}

}  // namespace

const std::vector<std::string>& gap_benchmark_parts() {
  static const std::vector<std::string> parts{"detectors", "approach",           "following",
                                              "bottle",    "faulted-approaches", "faulted-prints"};
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
  std::vector<std::vector<BottlePrint>> bottle(
      modes.size(), std::vector<BottlePrint>(static_cast<std::size_t>(request.machines)));

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
        jobs.add(fmt::format("bottle, machine {}, {}", k + 1, modes[m]),
                 [&, k, m] { bottle[m][k] = print_bottle(request, modes[m], request.seed + k); });
  jobs.run(request.threads, progress);
  if (wants("faulted-approaches"))
    benchmark.faulted.push_back(run_faulted_twin(faulted_request(request, FaultedTask::approach), progress));
  if (wants("faulted-prints"))
    benchmark.faulted.push_back(run_faulted_twin(faulted_request(request, FaultedTask::print), progress));

  for (const auto& rows : detectors)
    benchmark.detectors.insert(benchmark.detectors.end(), rows.begin(), rows.end());
  if (wants("approach")) benchmark.approaches = approaches;
  if (wants("following")) benchmark.followings = followings;
  if (wants("bottle"))
    for (std::size_t m = 0; m < modes.size(); ++m)
      benchmark.bottle.push_back(bottle_row(modes[m], bottle[m]));
  return benchmark;
}

bool GapBenchmark::good() const {
  for (const FaultedTwin& twin : faulted)
    for (const PlantTrials& on : twin.plants)
      if (!on.good()) return false;
  return true;
}

}  // namespace understudy::studies
