#include "regression/golden_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/yaml/yaml_map.h"
#include "core/yaml/yaml_quoted.h"
#include "regression/expectation_keys.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

constexpr int kVersion = 1;
constexpr const char* kSource = "golden";

void read_golden(YamlMap& map, FiguresOf of, std::vector<Expectation>& golden) {
  const int version = map.integer("golden", 0, 1'000'000, "version of this form: 1");
  if (!map.recording() && version != kVersion)
    map.fail("golden",
             fmt::format("golden is version {}, where this program reads {}: write the file again with "
                         "understudy scenario run --update-golden",
                         version, kVersion));
  golden = read_expectations(map, of);
  for (const Expectation& e : golden)
    if (!map.recording() && !e.equals)
      map.fail("expect", fmt::format("{} of a golden file has no 'equals'", e.metric));
}

/// What it does not tell of the machine and the program, but of this computer or of the files' names.
double tolerance_of(const std::string& metric, double value) {
  const std::string unit = metric_unit(metric);
  if (unit == "mm") return 0.001;
  if (unit == "um") return 1;
  if (unit == "mrad" || unit == "mm3") return 0.1;
  if (unit == "deg" || unit == "s") return 0.01;
  return metric.ends_with("fraction") || value != std::floor(value) ? 0.001 : 0;
}

/// `word`: the key of a word.
std::string entry_text(const std::string& metric, const MetricValue& value, double tolerance,
                       const char* word) {
  std::string text = fmt::format("  - {{metric: {}, ", yaml_quoted(metric));
  if (const auto* number = std::get_if<double>(&value)) {
    text += fmt::format("equals: {}", *number);
    if (tolerance > 0) text += fmt::format(", tolerance: {}", tolerance);
    if (const std::string unit = metric_unit(metric); unit != "1") text += ", unit: " + unit;
  } else {
    text += fmt::format("{}: {}", word, yaml_quoted(std::get<std::string>(value)));
  }
  return text + fmt::format(", source: {}}}\n", kSource);
}

}  // namespace

fs::path golden_file_of(const fs::path& scenario) {
  return scenario.parent_path() / "golden" / scenario.filename();
}

std::vector<Expectation> load_golden(const fs::path& path, FiguresOf of) {
  std::vector<Expectation> golden;
  YamlMap::read_text(read_file(path), path.string(), [&](YamlMap& map) { read_golden(map, of, golden); });
  return golden;
}

MapSchema golden_schema() {
  return YamlMap::schema([](YamlMap& map) {
    std::vector<Expectation> golden;
    read_golden(map, FiguresOf::run, golden);
  });
}

std::string golden_text(const Scenario& scenario, const Metrics& run,
                        const std::vector<Expectation>& before) {
  std::string text = fmt::format(
      "# The figures of {}, as `understudy scenario run --update-golden` wrote them. Tolerances are yours "
      "to\n"
      "# change, and entries to take out: both stay when the file is written again.\ngolden: {}\nexpect:\n",
      printable(scenario.file.filename().string()), kVersion);
  for (const auto& [metric, value] : run) {
    const auto known = std::ranges::find(before, metric, &Expectation::metric);
    if (const auto* word = std::get_if<std::string>(&value); word && word->empty()) continue;
    if (before.empty() ? metric_is_of_the_run(metric) : known == before.end()) continue;
    const double* number = std::get_if<double>(&value);
    const double fresh = number ? tolerance_of(metric, *number) : 0;
    text += entry_text(metric, value, known == before.end() ? fresh : known->tolerance,
                       scenario.command.empty() ? "equals" : "word");
  }
  return text;
}

}  // namespace understudy::regression
