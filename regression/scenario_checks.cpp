#include "regression/scenario_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "core/quantile.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kSeedsNamed = 10;

std::optional<double> number_in(const Metrics& metrics, const std::string& metric) {
  const auto found = metrics.find(metric);
  if (found == metrics.end() || !std::holds_alternative<double>(found->second)) return std::nullopt;
  return std::get<double>(found->second);
}

// A fraction has no unit, whatever the metric's.
std::string bound_unit(const Expectation& e) {
  return e.statistic == Statistic::fraction_within ? "1" : e.unit;
}

std::string bounds_text(const Expectation& e) {
  const std::string unit = bound_unit(e);
  if (e.equals && std::holds_alternative<std::string>(*e.equals))
    return "= " + std::get<std::string>(*e.equals);
  if (e.equals)
    return "= " + text_with_unit(std::get<double>(*e.equals), unit) +
           (e.tolerance > 0 ? fmt::format(" +- {}", text_with_unit(e.tolerance, unit)) : "");
  if (e.min && e.max) return fmt::format("in {:.6g}..{}", *e.min, text_with_unit(*e.max, unit));
  return e.min ? ">= " + text_with_unit(*e.min, unit) : "<= " + text_with_unit(*e.max, unit);
}

std::string subject(const Expectation& e, const Scenario& scenario) {
  if (e.statistic == Statistic::none) return e.metric;
  const std::string seeds =
      fmt::format("seeds {}-{}", scenario.machines->seed_first, scenario.machines->seed_last);
  if (e.statistic == Statistic::fraction_within)
    return fmt::format("fraction with {} in {:.6g}..{} over {}", e.metric, e.within_min,
                       text_with_unit(e.within_max, e.unit), seeds);
  return fmt::format("{} of {} over {}", to_string(e.statistic), e.metric, seeds);
}

// What a number breaks, as " is 0.4 mm, above 0.2 mm"; empty when it breaks nothing.
std::string broken_bound(const Expectation& e, double value) {
  const std::string unit = bound_unit(e);
  if (e.min && value < *e.min) return ", below " + text_with_unit(*e.min, unit);
  if (e.max && value > *e.max) return ", above " + text_with_unit(*e.max, unit);
  if (e.equals && std::abs(value - std::get<double>(*e.equals)) > e.tolerance)
    return ", not " + bounds_text(e).substr(2);
  return "";
}

struct Judgement {
  std::optional<MetricValue> value;
  bool ok = false;
  std::string text;  // after the subject: " is 0.41 mm, above 0.2 mm"
};

Judgement judge_number(const Expectation& e, double value, const std::string& aside) {
  const std::string broken = broken_bound(e, value);
  return {value, broken.empty(), " is " + text_with_unit(value, bound_unit(e)) + aside + broken};
}

Judgement judge_run(const Expectation& e, const Metrics& run) {
  const auto found = run.find(e.metric);
  if (found == run.end()) return {std::nullopt, false, " is absent from the result"};
  if (std::holds_alternative<double>(found->second)) {
    if (e.equals && std::holds_alternative<std::string>(*e.equals))
      return {found->second, false, " is not a word"};
    return judge_number(e, std::get<double>(found->second), "");
  }
  const std::string& word = std::get<std::string>(found->second);
  const bool ok = e.equals && *e.equals == found->second;
  return {found->second, ok, " is " + word + (ok ? "" : ", not " + bounds_text(e).substr(2))};
}

std::string seeds_text(const std::vector<std::uint64_t>& seeds) {
  std::string text = seeds.size() == 1 ? "seed " : "seeds ";
  for (std::size_t i = 0; i < std::min(seeds.size(), kSeedsNamed); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(seeds[i]);
  return text + (seeds.size() > kSeedsNamed ? ", ..." : "");
}

double statistic_of(Statistic statistic, const std::vector<double>& values) {
  switch (statistic) {
    case Statistic::min:
      return *std::min_element(values.begin(), values.end());
    case Statistic::max:
      return *std::max_element(values.begin(), values.end());
    case Statistic::mean:
      return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    case Statistic::median:
      return quantile(values, 0.5);
    case Statistic::p95:
      return quantile(values, 0.95);
    case Statistic::none:
    case Statistic::fraction_within:
      break;
  }
  throw std::logic_error("not a statistic of one number");
}

struct Gathered {
  std::vector<double> values;
  std::vector<std::uint64_t> seeds, absent;  // seeds[i] has values[i]
};

Gathered gather(const std::string& metric, std::span<const Metrics> machines, std::uint64_t seed_first) {
  Gathered gathered;
  for (std::size_t i = 0; i < machines.size(); ++i) {
    const auto value = number_in(machines[i], metric);
    if (!value)
      gathered.absent.push_back(seed_first + i);
    else {
      gathered.values.push_back(*value);
      gathered.seeds.push_back(seed_first + i);
    }
  }
  return gathered;
}

Judgement judge_fraction(const Expectation& e, const Gathered& gathered) {
  std::vector<std::uint64_t> outside;
  for (std::size_t i = 0; i < gathered.values.size(); ++i)
    if (gathered.values[i] < e.within_min || gathered.values[i] > e.within_max)
      outside.push_back(gathered.seeds[i]);
  const auto count = static_cast<double>(gathered.values.size() + gathered.absent.size());
  const double sure = static_cast<double>(gathered.values.size() - outside.size()) / count;
  const double possible = sure + static_cast<double>(gathered.absent.size()) / count;
  std::string aside = outside.empty() ? "" : ", outside: " + seeds_text(outside);
  if (!gathered.absent.empty()) aside += ", absent: " + seeds_text(gathered.absent);
  const std::string broken =
      broken_bound(e, sure).empty() ? broken_bound(e, possible) : broken_bound(e, sure);
  return {sure, broken.empty(), " is " + text_with_unit(sure, "1") + broken + aside};
}

Judgement judge_machines(const Expectation& e, std::span<const Metrics> machines, std::uint64_t seed_first) {
  const Gathered gathered = gather(e.metric, machines, seed_first);
  if (e.statistic == Statistic::fraction_within) return judge_fraction(e, gathered);
  if (!gathered.absent.empty())
    return {std::nullopt, false,
            fmt::format(" cannot be told: absent from {} of {} machines ({})", gathered.absent.size(),
                        machines.size(), seeds_text(gathered.absent))};
  const double value = statistic_of(e.statistic, gathered.values);
  const auto at = std::find(gathered.values.begin(), gathered.values.end(), value);
  const bool extreme = e.statistic == Statistic::min || e.statistic == Statistic::max;
  const std::string aside =
      extreme
          ? fmt::format(" (seed {})", gathered.seeds[static_cast<std::size_t>(at - gathered.values.begin())])
          : "";
  return judge_number(e, value, aside);
}

Check make_check(const Expectation& e, const Scenario& scenario, const Judgement& judgement,
                 const fs::path& file) {
  Check check;
  check.expectation = e;
  check.value = judgement.value;
  check.ok = judgement.ok;
  check.name = subject(e, scenario) + " " + bounds_text(e);
  check.message =
      fmt::format("{}{} ({}:{}; {})", subject(e, scenario), judgement.text, file.string(), e.line, e.source);
  return check;
}

}  // namespace

const char* to_string(Statistic s) {
  switch (s) {
    case Statistic::none:
      return "none";
    case Statistic::min:
      return "min";
    case Statistic::max:
      return "max";
    case Statistic::mean:
      return "mean";
    case Statistic::median:
      return "median";
    case Statistic::p95:
      return "p95";
    case Statistic::fraction_within:
      return "fraction_within";
  }
  throw std::logic_error("unknown statistic");
}

std::vector<Check> evaluate(const Scenario& scenario, const Metrics& run, std::span<const Metrics> machines) {
  const std::uint64_t expected = scenario.machines ? scenario.machines->count() : 0;
  if (machines.size() != expected)
    throw std::logic_error(
        fmt::format("scenario {} has {} machines, not {}", scenario.name, expected, machines.size()));
  std::vector<Check> checks;
  const fs::path file = scenario.file.filename();
  for (const Expectation& e : scenario.expect)
    checks.push_back(make_check(e, scenario, judge_run(e, run), file));
  if (scenario.machines)
    for (const Expectation& e : scenario.machines->expect)
      checks.push_back(
          make_check(e, scenario, judge_machines(e, machines, scenario.machines->seed_first), file));
  for (const Expectation& e : scenario.golden)
    checks.push_back(make_check(e, scenario, judge_run(e, run), "golden" / file));
  return checks;
}

bool ScenarioResult::passed() const {
  return error.empty() && !checks.empty() &&
         std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
}

}  // namespace understudy::regression
