#include "regression/scenario_file.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "core/output_file.h"
#include "core/strict_yaml.h"
#include "regression/scenario_faults.h"
#include "rehearsal/run_twin.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

using namespace rehearsal;

const std::vector<std::string> kAsBuilt{"nominal", "sampled", "manufactured"};
const std::vector<std::string> kGapControls{"off", "start", "continuous"};
const std::vector<std::string> kStatistics{"min", "max", "mean", "median", "p95", "fraction_within"};
constexpr std::uint64_t kMachinesMax = 1'000'000;  // beyond it a range of seeds is a slip of the pen

fs::path existing_file(StrictMap& map, const std::string& key, const fs::path& folder) {
  const fs::path path = (folder / map.text(key)).lexically_normal();
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    map.fail(key, key + " " + path.string() + " does not exist or is not a file");
  return path;
}

bool is_path(const std::string& text, const std::string& extension) {
  return text.find('/') != std::string::npos || text.ends_with(extension);
}

std::string name_or_path(StrictMap& map, const std::string& key, const fs::path& folder,
                         const std::string& extension) {
  const std::string text = map.text(key);
  if (!is_path(text, extension)) return text;
  const fs::path path = (folder / text).lexically_normal();
  std::error_code ignored;
  if (!fs::exists(path, ignored)) map.fail(key, key + " " + path.string() + " does not exist");
  return path.string();
}

std::string read_metric(StrictMap& map) {
  const std::string metric = map.text("metric");
  const std::vector<std::string>& known = metric_names();
  if (std::find(known.begin(), known.end(), metric) != known.end()) return metric;
  const std::string nearest = nearest_word(metric, known);
  map.fail("metric",
           "unknown metric '" + metric + "'" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

void read_unit(StrictMap& map, Expectation& expectation) {
  const std::string of_metric = metric_unit(expectation.metric);
  if (!map.has("unit")) {
    if (of_metric != "1")
      map.fail("metric", "the bound on " + expectation.metric + " lacks its unit: " + of_metric);
    expectation.unit = "1";
    return;
  }
  expectation.unit = map.text("unit");
  if (expectation.unit != of_metric)
    map.fail("unit", fmt::format("{} is in {}, not in {}", expectation.metric,
                                 of_metric == "1" ? "1 (no unit)" : of_metric, expectation.unit));
}

void read_text_bound(StrictMap& map, Expectation& expectation) {
  for (const char* key : {"min", "max", "tolerance", "unit"})
    if (map.has(key)) map.fail(key, fmt::format("{} is a word; it has no '{}'", expectation.metric, key));
  expectation.equals =
      expectation.metric == "verdict" ? map.word("equals", {"go", "no-go"}) : map.text("equals");
}

void read_number_bounds(StrictMap& map, Expectation& expectation) {
  if (map.has("min")) expectation.min = map.number("min");
  if (map.has("max")) expectation.max = map.number("max");
  if (map.has("equals")) expectation.equals = map.number("equals");
  if (map.has("tolerance")) {
    if (!expectation.equals) map.fail("tolerance", "'tolerance' goes with 'equals' only");
    expectation.tolerance = map.number("tolerance");
    if (expectation.tolerance < 0)
      map.fail("tolerance", fmt::format("tolerance {} is below 0", expectation.tolerance));
  }
  const bool range = expectation.min || expectation.max;
  if (!range && !expectation.equals)
    map.fail("metric", "the expectation of " + expectation.metric + " has no bound: min, max or equals");
  if (range && expectation.equals) map.fail("equals", "'equals' excludes 'min' and 'max'");
  if (expectation.min && expectation.max && *expectation.min > *expectation.max)
    map.fail("min", fmt::format("min {} is above max {}", *expectation.min, *expectation.max));
  read_unit(map, expectation);
}

void read_statistic(StrictMap& map, Expectation& expectation) {
  if (metric_is_text(expectation.metric))
    map.fail("metric", expectation.metric + " is a word; it has no statistic");
  const std::string word = map.word("statistic", kStatistics);
  for (const Statistic s : {Statistic::min, Statistic::max, Statistic::mean, Statistic::median,
                            Statistic::p95, Statistic::fraction_within})
    if (word == to_string(s)) expectation.statistic = s;
  if (expectation.statistic != Statistic::fraction_within) {
    if (map.has("within")) map.fail("within", "'within' goes with the statistic fraction_within only");
    return;
  }
  const std::vector<double> within = map.numbers("within", 2);
  if (within[0] > within[1]) map.fail("within", fmt::format("within: {} is above {}", within[0], within[1]));
  expectation.within_min = within[0];
  expectation.within_max = within[1];
}

void require_fraction_bounds(const StrictMap& map, const Expectation& expectation) {
  const auto check = [&](const char* key, const std::optional<double>& bound) {
    if (bound && (*bound < 0 || *bound > 1))
      map.fail(key, fmt::format("{} {} is not a fraction from 0 to 1", key, *bound));
  };
  check("min", expectation.min);
  check("max", expectation.max);
  if (expectation.equals) check("equals", std::get<double>(*expectation.equals));
}

std::vector<Expectation> read_expectations(StrictMap& parent, bool over_machines) {
  std::vector<Expectation> expectations;
  for (StrictMap& map : parent.list_of_maps("expect", "an expectation")) {
    Expectation expectation;
    expectation.line = map.line();
    expectation.metric = read_metric(map);
    if (over_machines)
      read_statistic(map, expectation);
    else if (metric_is_of_series(expectation.metric))
      map.fail("metric", expectation.metric + " exists under 'machines' only");
    else if (map.has("statistic"))
      map.fail("statistic", "'statistic' is for expectations under 'machines'");
    if (metric_is_text(expectation.metric))
      read_text_bound(map, expectation);
    else
      read_number_bounds(map, expectation);
    if (expectation.statistic == Statistic::fraction_within) require_fraction_bounds(map, expectation);
    expectation.source = map.text("source");
    map.close();
    expectations.push_back(std::move(expectation));
  }
  return expectations;
}

MachineSeries read_machines(StrictMap map) {
  MachineSeries series;
  const std::string text = map.text("seeds");
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, series.seed_first);
  const bool dash = first.ec == std::errc() && first.ptr != end && *first.ptr == '-';
  const auto last = dash ? std::from_chars(first.ptr + 1, end, series.seed_last) : first;
  if (!dash || last.ec != std::errc() || last.ptr != end)
    map.fail("seeds", "'seeds' of machines must be a range like 1-200, not '" + text + "'");
  if (series.seed_last < series.seed_first) map.fail("seeds", "seeds " + text + " run backwards");
  if (series.seed_last - series.seed_first >= kMachinesMax)
    map.fail("seeds", fmt::format("seeds {} are more than {} machines", text, kMachinesMax));
  series.expect = read_expectations(map, true);
  map.close();
  return series;
}

// How the program is read, what it prints with, and what is asked about the surface; all may be left out.
void read_program_options(StrictMap& map, const fs::path& folder, Scenario& scenario) {
  if (map.has("material")) scenario.material = name_or_path(map, "material", folder, ".yaml");
  DialectRequest& dialect = scenario.dialect;
  if (map.has("place_mm")) {
    const auto place = map.numbers("place_mm", 3);
    std::copy(place.begin(), place.end(), dialect.place_mm.begin());
  }
  if (map.has("extruder_letter")) dialect.extruder_letter = map.word("extruder_letter", {"E", "A"});
  if (map.has("b_sign")) dialect.b_sign = map.number("b_sign") < 0 ? -1 : 1;
  if (map.has("c_sign")) dialect.c_sign = map.number("c_sign") < 0 ? -1 : 1;
  if (map.has("coordinates")) dialect.coordinates = map.word("coordinates", {"tip", "machine", "crossing"});
  SurfaceRequest& surface = scenario.surface;
  if (map.has("intended")) surface.intended = name_or_path(map, "intended", folder, ".stl");
  if (map.has("profile_mm")) surface.profile_mm = map.numbers("profile_mm", 6);
  if (map.has("probe")) surface.probe = map.numbers("probe", 3);
}

}  // namespace

Scenario load_scenario(const fs::path& path) {
  StrictMap map(parse_yaml(read_file(path), path.string()), path.string(), "the scenario");
  const fs::path folder = path.parent_path();
  Scenario scenario;
  scenario.file = path;
  scenario.name = map.text("name");
  scenario.description = map.text("description");
  scenario.source = map.text("source");
  scenario.machine = name_or_path(map, "machine", folder, ".yaml");
  scenario.program = existing_file(map, "program", folder);
  if (map.has("fixture")) scenario.fixture = name_or_path(map, "fixture", folder, ".stl");
  scenario.as_built = is_path(map.text("as_built"), ".yaml") ? name_or_path(map, "as_built", folder, ".yaml")
                                                             : map.word("as_built", kAsBuilt);
  scenario.seed = map.whole_number("seed");
  scenario.gap_control = map.word("gap_control", kGapControls);
  scenario.engine = map.word("engine", engine_names());
  read_program_options(map, folder, scenario);
  scenario.faults = read_faults(map);
  scenario.expect = read_expectations(map, false);
  if (map.has("machines")) scenario.machines = read_machines(map.map("machines", "machines"));
  map.close();
  return scenario;
}

std::vector<fs::path> find_scenarios(std::span<const fs::path> paths) {
  std::vector<fs::path> found;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (!fs::exists(path, error))
      throw InputError("cannot read " + path.string() + ": no such file or folder");
    if (!fs::is_directory(path, error)) {
      found.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.is_regular_file() && entry.path().extension() == ".yaml") inside.push_back(entry.path());
    if (inside.empty()) throw InputError("there is no scenario (*.yaml) in " + path.string());
    std::sort(inside.begin(), inside.end());
    found.insert(found.end(), inside.begin(), inside.end());
  }
  return found;
}

}  // namespace understudy::regression
