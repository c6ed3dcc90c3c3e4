#include "regression/expectation_keys.h"

#include <array>

#include <fmt/format.h>

#include "core/yaml/yaml_map.h"
#include "regression/metrics.h"

namespace understudy::regression {
namespace {

const std::vector<std::string> kStatistics{"min", "max", "mean", "median", "p95", "fraction_within"};

std::string read_metric(YamlMap& map, bool over_machines) {
  std::vector<std::string> words;
  for (const std::string& name : metric_names()) {
    // The others are refused below, with a reason.
    const bool fits = over_machines ? !metric_is_text(name) : !metric_is_of_series(name);
    if (fits || !map.recording()) words.push_back(name);
  }
  const std::string metric = map.word("metric", words, "figure of the run");
  map.require("metric");
  if (!over_machines && metric_is_of_series(metric))
    map.fail("metric", metric + " exists under 'machines' only");
  return metric;
}

void read_unit(YamlMap& map, Expectation& expectation) {
  constexpr const char* kAbout = "that of the metric; 1 of counts and fractions";
  const std::string of_metric = metric_unit(expectation.metric);
  expectation.unit = of_metric;
  if (of_metric == "1" && !map.has("unit")) return;
  const bool told = map.recording() && !expectation.metric.empty();  // a command's figure has any name
  const std::string unit = told ? map.word("unit", {of_metric}, kAbout) : map.text("unit", kAbout);
  if (map.recording()) return;
  if (unit.empty())
    map.fail("metric", "the bound on " + expectation.metric + " lacks its unit: " + of_metric);
  if (unit != of_metric)
    map.fail("unit", fmt::format("{} is in {}, not in {}", expectation.metric,
                                 of_metric == "1" ? "1 (no unit)" : of_metric, unit));
}

void read_text_bound(YamlMap& map, Expectation& expectation) {
  for (const char* key : {"min", "max", "tolerance", "unit"})
    map.refuse(key, fmt::format("{} is a word; it has no '{}'", expectation.metric, key));
  std::vector<std::string> words;
  if (expectation.metric == "verdict") words = {"go", "no-go"};
  if (expectation.metric == "grade") words = {"go", "go-with-warnings", "no-go"};
  expectation.equals = map.word("equals", words, "the word that it must be");
}

void read_number_bounds(YamlMap& map, Expectation& expectation) {
  const Bounds any = expectation.statistic == Statistic::fraction_within ? Bounds{0, 1} : Bounds{};
  if (map.has("equals")) {
    for (const char* key : {"min", "max"}) map.refuse(key, "'equals' excludes 'min' and 'max'");
    expectation.equals = map.number("equals", any, "the value that it must have, but for the tolerance");
    if (map.has("tolerance")) expectation.tolerance = map.number("tolerance", {0}, "either way of equals");
  } else {
    map.refuse("tolerance", "'tolerance' goes with 'equals' only");
    if (map.has("min")) expectation.min = map.number("min", any, "least good value");
    if (map.has("max")) expectation.max = map.number("max", any, "greatest good value");
    if (!expectation.min && !expectation.max)
      map.fail("metric", "the expectation of " + expectation.metric + " has no bound: min, max or equals");
  }
  if (expectation.min && expectation.max && *expectation.min > *expectation.max)
    map.fail("min", fmt::format("min {} is above max {}", *expectation.min, *expectation.max));
  read_unit(map, expectation);
}

void read_statistic(YamlMap& map, Expectation& expectation) {
  if (metric_is_text(expectation.metric))
    map.fail("metric", expectation.metric + " is a word; it has no statistic");
  const std::string word = map.word("statistic", kStatistics, "over all machines");
  for (const Statistic s : {Statistic::min, Statistic::max, Statistic::mean, Statistic::median,
                            Statistic::p95, Statistic::fraction_within})
    if (word == to_string(s)) expectation.statistic = s;
  if (expectation.statistic != Statistic::fraction_within)
    return map.refuse("within", "'within' goes with the statistic fraction_within only");
  const std::vector<double> within = map.numbers("within", 2, {}, "ends of the range, included");
  if (within[0] > within[1]) map.fail("within", fmt::format("within: {} is above {}", within[0], within[1]));
  expectation.within_min = within[0];
  expectation.within_max = within[1];
}

Expectation read_figure(YamlMap& map) {
  Expectation expectation;
  expectation.line = map.place().line;
  expectation.metric = map.text("metric", "dotted name of a figure in the command's JSON, its file first");
  map.require("metric");
  if (map.has("word")) {
    for (const char* key : {"equals", "min", "max", "tolerance", "unit"})
      map.refuse(key, fmt::format("'word' excludes '{}'", key));
    expectation.equals = map.text("word", "the word that it must be");
  } else {
    read_number_bounds(map, expectation);
  }
  expectation.source = map.text("source", "where the bound comes from");
  return expectation;
}

Expectation read_expectation(YamlMap& map, FiguresOf of) {
  if (of == FiguresOf::command) return read_figure(map);
  const bool over_machines = of == FiguresOf::machines;
  Expectation expectation;
  expectation.line = map.place().line;
  expectation.metric = read_metric(map, over_machines);
  if (over_machines)
    read_statistic(map, expectation);
  else
    map.refuse("statistic", "'statistic' is for expectations under 'machines'");
  if (metric_is_text(expectation.metric))
    read_text_bound(map, expectation);
  else
    read_number_bounds(map, expectation);
  expectation.source = map.text("source", "where the bound comes from");
  return expectation;
}

/// Found once: every variant of a scenario holds the same.
const MapSchema& expectation_schema(FiguresOf of) {
  const auto found = [](FiguresOf each) {
    return YamlMap::schema([each](YamlMap& map) { read_expectation(map, each); });
  };
  static const std::array<MapSchema, 3> schemas{found(FiguresOf::run), found(FiguresOf::machines),
                                                found(FiguresOf::command)};
  return schemas.at(static_cast<std::size_t>(of));
}

}  // namespace

std::vector<Expectation> read_expectations(YamlMap& parent, FiguresOf of) {
  std::vector<Expectation> expectations;
  constexpr const char* kAbout = "what the figures must be";
  if (parent.recording()) {
    parent.record_list("expect", kAbout, expectation_schema(of));
    return expectations;
  }
  parent.list("expect", 0, kAbout,
              [&](YamlMap& map, std::size_t) { expectations.push_back(read_expectation(map, of)); });
  return expectations;
}

}  // namespace understudy::regression
