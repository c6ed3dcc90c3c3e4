#include "report/recorded/recorded_rehearsal.h"

#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/is_file.h"
#include "core/file/read_file.h"
#include "report/json_figures.h"
#include "report/recorded/recorded_trace.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using rehearsal::FindingGroup;

constexpr const char* kSummaryFile = "summary.json";
constexpr const char* kTraceFile = "trace.csv";
constexpr const char* kAsBuiltFile = "as-built.yaml";

int count_at(const Json& object, const char* key) {
  const Json& value = object.at(key);
  const std::int64_t count = value.is_number_integer() ? value.get<std::int64_t>() : -1;
  if (count < 0 || count > std::numeric_limits<int>::max())
    throw std::runtime_error(fmt::format("{} is {}", key, value.dump()));
  return static_cast<int>(count);
}

rehearsal::Severity severity_of(const Json& object) {
  const auto word = object.at("severity").get<std::string>();
  if (word != "error" && word != "warning")
    throw std::runtime_error(fmt::format("severity is '{}', neither error nor warning", word));
  return word == "error" ? rehearsal::Severity::error : rehearsal::Severity::warning;
}

rehearsal::Grade grade_at(const Json& summary) {
  const auto word = summary.at("grade").get<std::string>();
  const auto grade = rehearsal::grade_of_word(word);
  if (!grade) throw std::runtime_error(fmt::format("grade is '{}', which is none", word));
  return *grade;
}

FindingGroup group_of(const Json& object) {
  FindingGroup group;
  group.count = count_at(object, "count");
  if (object.contains("first_line")) {
    group.first_line = count_at(object, "first_line");
    group.last_line = count_at(object, "last_line");
  }
  const Json& worst = object.at("worst");
  group.worst.kind = object.at("kind").get<std::string>();
  group.worst.severity = severity_of(object);
  if (worst.contains("gcode_line")) group.worst.gcode_line = count_at(worst, "gcode_line");
  group.worst.time_s = worst.at("time_s").get<double>();
  group.worst.value = worst.at("value").get<double>();
  group.worst.limit = worst.at("limit").get<double>();
  group.worst.unit = worst.at("unit").get<std::string>();
  group.worst.message = worst.at("message").get<std::string>();
  return group;
}

std::string input_name(const std::string& key) {
  if (key == "version") return "understudy";
  if (key == "as_built") return "as-built machine";
  const auto end = key.rfind("_sha256");
  return end == std::string::npos ? key : key.substr(0, end) + " file";
}

std::string plain(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::map<std::string, std::string> inputs_of(const Json& summary, const fs::path& folder) {
  std::map<std::string, std::string> inputs;
  for (const auto& [key, value] : summary.at("provenance").items()) {
    if (key == "command" || key == "inputs_sha256") continue;
    if (value.is_object())
      for (const auto& [library, version] : value.items()) inputs["library " + library] = plain(version);
    else
      inputs[input_name(key)] = plain(value);
  }
  if (summary.contains("engine")) inputs["engine"] = plain(summary.at("engine").at("name"));
  if (is_file(folder / kAsBuiltFile)) inputs[kAsBuiltFile] = sha256_hex(read_file(folder / kAsBuiltFile));
  return inputs;
}

regression::Metrics figures_of(const std::string& text, const std::string& file) {
  regression::Metrics figures = json_figures(text, file);
  for (const char* word : {"schema", "verdict", "go", "grade", "engine.name"}) figures.erase(word);
  std::erase_if(figures, [](const auto& figure) {
    return figure.first.starts_with("findings.") || figure.first.starts_with("finding_groups.") ||
           figure.first.starts_with("provenance.");
  });
  return figures;
}

}  // namespace

RecordedRehearsal read_recorded_rehearsal(const fs::path& folder) {
  RecordedRehearsal read;
  read.folder = folder;
  if (!is_folder(folder))
    throw InputError(
        fmt::format("{} is no folder: name one that understudy rehearse wrote", folder.string()));
  read.run = read_recorded_run(folder);
  check_as_written(folder, kSummaryFile);
  const fs::path file = folder / kSummaryFile;
  const std::string text = read_file(file);
  bool simulated = false;
  try {
    const Json summary = Json::parse(text);
    read.grade = grade_at(summary);
    for (const Json& group : summary.at("finding_groups")) read.findings.push_back(group_of(group));
    read.inputs = inputs_of(summary, folder);
    simulated = summary.contains("print") && summary.at("print").at("duration_s").get<double>() > 0;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(Place{file.string()},
                     fmt::format("it is damaged, or an older version wrote it: {}", error.what()));
  }
  read.figures = figures_of(text, file.string());
  if (!simulated) return read;
  if (!is_file(folder / kTraceFile))
    throw InputError(Place{(folder / kTraceFile).string()}, "it is missing: the result is not whole");
  check_as_written(folder, kTraceFile);
  read.trace = read_recorded_trace(folder / kTraceFile);
  return read;
}

}  // namespace understudy::report
