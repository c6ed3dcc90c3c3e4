#include "studies/calibration/calibration_benchmark.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/plugin/plugin_estimator.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "core/units.h"
#include "studies/calibration/plant_session.h"

namespace understudy::studies {
namespace {

using Progress = std::function<void(double, const std::string&)>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A bundle adjustment, or an estimator by its name.
Method method_named(const std::string& name, bool on_plant, calibration::MachineKind kind) {
  const auto& bundles = bundle_names();
  if (std::find(bundles.begin(), bundles.end(), name) == bundles.end())
    return {name, false, calibration::make_estimator(name, kind)};
  if (!on_plant) throw InputError(fmt::format("--estimators {}: needs --from pixels and --engine", name));
  return {name, false, nullptr, name == bundles.back()};
}

std::vector<Method> entrants_of(const CalibrationBenchmarkRequest& request, bool chain) {
  const auto kind = chain ? calibration::MachineKind::chain : calibration::MachineKind::hexapod;
  const bool on_plant = !request.engine.empty();
  std::vector<std::string> names = request.estimators;
  if (names.empty() && request.own.empty()) {
    names = calibration::estimator_names(kind);
    if (on_plant) names = {"maximum_likelihood", "with_play"};
    if (on_plant) names.insert(names.end(), bundle_names().begin(), bundle_names().end());
  }
  std::vector<Method> entrants;
  for (const std::string& name : names) entrants.push_back(method_named(name, on_plant, kind));
  for (const std::string& command : request.plugins)
    entrants.push_back({command, true, calibration::make_plugin_estimator(command, request.plugin_limits)});
  entrants.insert(entrants.end(), request.own.begin(), request.own.end());
  for (std::size_t i = 0; i < entrants.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (entrants[i].name == entrants[j].name)
        throw InputError(fmt::format("'{}' is entered twice", entrants[i].name));
  return entrants;
}

std::vector<Disturbance> disturbances_of(const CalibrationBenchmarkRequest& request, bool chain) {
  std::vector<Disturbance> wanted = request.disturbances;
  const auto hexapods_only = [](Disturbance d) {
    return d == Disturbance::deviation || d == Disturbance::drift;
  };
  const auto drawn_only = [&](Disturbance d) {
    return !request.engine.empty() && (d == Disturbance::outliers || d == Disturbance::boards);
  };
  if (wanted.empty()) {
    wanted = all_disturbances();
    if (chain) std::erase_if(wanted, hexapods_only);
    std::erase_if(wanted, drawn_only);
  }
  for (const Disturbance d : wanted) {
    if (chain && hexapods_only(d))
      throw InputError(fmt::format("--disturbances {}: a chain has no screw struts", to_string(d)));
    if (drawn_only(d))
      throw InputError(
          fmt::format("--disturbances {}: not with --engine, whose boards are always misplaced "
                      "and whose pictures are all of the machine",
                      to_string(d)));
  }
  return wanted;
}

std::vector<Condition> conditions_of(const CalibrationBenchmarkRequest& request, bool chain) {
  std::vector<Condition> conditions;
  auto noise = request.noise;
  if (request.from == MeasuredFrom::pixels) noise = {calibration::MeasurementNoise{}};
  for (const Disturbance d : disturbances_of(request, chain))
    for (const auto& level : noise)
      for (const std::size_t poses : request.poses) conditions.push_back({level, poses, d});
  return conditions;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return sum / static_cast<double>(values.size());
}

constexpr double kTipFreedoms = 3;
constexpr double kEllipsoid95 = 7.815;  // chi-square of these

StatedScore stated_score(const std::vector<Trial>& trials, std::size_t entrant, StatedErrors Answer::*which) {
  std::vector<double> errors, medians, stated;
  double chi_square = 0;
  int inside = 0, counted = 0;
  for (const Trial& trial : trials) {
    const StatedErrors& of = trial.answers[entrant].*which;
    if (of.errors.empty()) continue;
    errors.insert(errors.end(), of.errors.begin(), of.errors.end());
    medians.push_back(quantile(of.errors, 0.5));
    stated.insert(stated.end(), of.stated.begin(), of.stated.end());
    for (const double v : of.normalised) {
      ++counted;
      chi_square += v / kTipFreedoms;
      inside += v < kEllipsoid95;
    }
  }
  if (errors.empty()) return {kNone, kNone, kNone, kNone, kNone, kNone};
  StatedScore score{quantile(errors, 0.5), quantile(errors, 1), quantile(medians, 1), kNone, kNone, kNone};
  if (counted == 0) return score;
  score.ratio = std::sqrt(mean_square(errors) / mean_square(stated));
  score.chi_square = chi_square / counted;
  score.coverage = static_cast<double>(inside) / counted;
  return score;
}

/// One entrant's column of a condition. `fallback`: its errors where failures count as no calibration.
EntrantScore score_of(const std::vector<Trial>& trials, std::size_t entrant, double& fallback) {
  EntrantScore score;
  std::vector<double> errors, with_failures, times, misfits;
  double excess = 0;
  int bounded = 0;
  for (const Trial& trial : trials) {
    const Answer& answer = trial.answers[entrant];
    ++score.runs;
    times.push_back(answer.seconds);
    const std::vector<double>& counted = answer.ok() ? answer.errors : trial.uncalibrated;
    with_failures.insert(with_failures.end(), counted.begin(), counted.end());
    if (!answer.ok()) {
      ++score.failures;
      ++score.reasons[answer.failure];
      continue;
    }
    errors.insert(errors.end(), answer.errors.begin(), answer.errors.end());
    misfits.push_back(answer.misfit);
    if (trial.bound <= 0) continue;
    excess += mean_square(answer.errors) / (trial.bound * trial.bound);
    ++bounded;
  }
  score.median = quantile(errors, 0.5);
  score.p95 = quantile(errors, 0.95);
  score.rms = errors.empty() ? kNone : std::sqrt(mean_square(errors));
  score.efficiency = bounded > 0 ? bounded / excess : kNone;
  score.seconds = quantile(times, 0.5);
  score.misfit = misfits.empty() ? 0 : quantile(misfits, 0.5);
  score.in_frame = stated_score(trials, entrant, &Answer::in_frame);
  score.registered = stated_score(trials, entrant, &Answer::registered);
  fallback = quantile(with_failures, 0.5);
  return score;
}

ConditionScore score_condition(const Condition& condition, const std::vector<Trial>& trials,
                               std::size_t entrants) {
  ConditionScore result;
  result.condition = condition;
  std::vector<double> bounds, uncalibrated, fallback(entrants);
  for (const Trial& trial : trials) {
    if (trial.bound > 0) bounds.push_back(trial.bound);
    uncalibrated.insert(uncalibrated.end(), trial.uncalibrated.begin(), trial.uncalibrated.end());
    result.lost_poses += trial.lost_poses;
    result.beyond = std::max(result.beyond, trial.beyond);
  }
  result.bound = bounds.empty() ? 0 : quantile(bounds, 0.5);
  result.uncalibrated = quantile(uncalibrated, 0.5);
  for (std::size_t e = 0; e < entrants; ++e) result.scores.push_back(score_of(trials, e, fallback[e]));
  const auto best = std::min_element(fallback.begin(), fallback.end());
  result.best = static_cast<std::size_t>(best - fallback.begin());
  for (std::size_t e = 0; e < entrants; ++e) result.scores[e].relative = fallback[e] / *best;
  for (const Trial& trial : trials)
    result.machine_medians.push_back(quantile(trial.answers[result.best].errors, 0.5));
  return result;
}

std::vector<Standing> rank(const CalibrationBenchmark& benchmark) {
  std::vector<Standing> ranking;
  for (std::size_t e = 0; e < benchmark.entrants.size(); ++e) {
    Standing standing{e, 0, 0, 0};
    for (const ConditionScore& c : benchmark.conditions) {
      standing.score += std::log(c.scores[e].relative) / static_cast<double>(benchmark.conditions.size());
      standing.runs += c.scores[e].runs;
      standing.failures += c.scores[e].failures;
    }
    standing.score = std::exp(standing.score);
    ranking.push_back(standing);
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const Standing& a, const Standing& b) { return a.score < b.score; });
  return ranking;
}

}  // namespace

namespace {

/// The stands that all machines share where there is no plant.
struct SharedStands {
  std::optional<MeasuringStand> stand, misplaced;

  SharedStands(const CalibrationBenchmarkRequest& request, const machine::MachineDescription& machine,
               const std::vector<Condition>& conditions, TrialSetting& setting, const Progress& progress) {
    const auto photograph = [&](double share) {
      if (progress) progress(share, "boards before the cameras");
    };
    StandOptions options = setting.stand_options;
    setting.stand = &stand.emplace(machine, options, request.threads, photograph);
    if (std::none_of(conditions.begin(), conditions.end(),
                     [](const Condition& c) { return c.disturbance == Disturbance::boards; }))
      return;
    options.boards = {0.2e-3, 2e-3, 0};
    setting.misplaced_stand = &misplaced.emplace(machine, options, request.threads, photograph);
  }
};

void check_engine(const CalibrationBenchmarkRequest& request, const machine::MachineDescription& machine) {
  if (request.engine.empty()) return;
  if (request.from != MeasuredFrom::pixels) throw InputError("--engine: needs --from pixels");
  if (machine.is_chain())
    throw InputError(
        fmt::format("--engine: the two cameras are made for a hexapod, not for {}", machine.name));
  const auto& known = session_engines();
  if (std::find(known.begin(), known.end(), request.engine) == known.end())
    throw InputError(
        fmt::format("--engine '{}' is not known (known: {})", request.engine, fmt::join(known, " ")));
}

}  // namespace

CalibrationBenchmark run_benchmark(const CalibrationBenchmarkRequest& request, const Progress& progress) {
  const machine::MachineDescription machine = machine::load_machine(request.machine);
  const bool chain = machine.is_chain(), pixels = request.from == MeasuredFrom::pixels;
  if (chain && !machine.chain().kinematics.chain.rods.empty())
    throw InputError(machine.name + ": the estimators know trees of axes, and here rods carry the tool");
  check_engine(request, machine);
  CalibrationBenchmark benchmark{request, machine.name, machine.sha256, entrants_of(request, chain), {}, {}};
  const std::vector<Condition> conditions = conditions_of(request, chain);
  TrialSetting setting;
  setting.machine = &machine;
  setting.entrants = benchmark.entrants;
  setting.choice = request.choice;
  setting.seed = request.seed;

  setting.stand_options = request.stand;
  setting.stand_options.seed = request.seed;
  setting.engine = request.engine;
  std::optional<SharedStands> stands;
  if (pixels && request.engine.empty()) stands.emplace(request, machine, conditions, setting, progress);
  const auto room = chain                    ? make_chain_trials(setting)
                    : request.engine.empty() ? make_hexapod_trials(setting)
                                             : make_plant_trials(setting);
  const auto machines = static_cast<std::size_t>(request.trials);
  std::vector<std::vector<Trial>> trials(conditions.size(), std::vector<Trial>(machines));
  const std::size_t count = conditions.size() * machines;
  const auto calibrator = [&] {
    const auto view = pixels ? std::make_shared<renderer::CalibrationView>() : nullptr;
    return IndexedWork([&, view](std::size_t n) {
      const std::size_t c = n / machines, m = n % machines;
      trials[c][m] = room->run(conditions[c], static_cast<int>(m), view.get());
    });
  };
  in_parallel_with(count, request.threads, calibrator, [&](std::size_t, std::size_t done) {
    if (progress) progress(static_cast<double>(done) / static_cast<double>(count), "calibrating");
  });
  for (std::size_t c = 0; c < conditions.size(); ++c)
    benchmark.conditions.push_back(score_condition(conditions[c], trials[c], benchmark.entrants.size()));
  benchmark.ranking = rank(benchmark);
  return benchmark;
}

std::vector<std::string> without_answer(const CalibrationBenchmark& benchmark) {
  std::vector<std::string> names;
  for (const Standing& standing : benchmark.ranking)
    if (standing.failures == standing.runs) names.push_back(benchmark.entrants[standing.entrant].name);
  return names;
}

std::string to_string(const Condition& condition, MeasuredFrom from) {
  const std::string noise = from == MeasuredFrom::pixels
                                ? "from pixels"
                                : fmt::format("{:g} um and {:g} mrad", to_um(condition.noise.position),
                                              1e3 * condition.noise.rotation);
  return fmt::format("{} poses, {}, {}", condition.poses, noise, to_string(condition.disturbance));
}

}  // namespace understudy::studies
