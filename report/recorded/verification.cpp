#include "report/recorded/verification.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/file/is_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/text/json_depth.h"
#include "report/summary_json.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
constexpr std::size_t kKeysShown = 3;

bool is_json(const std::string& name) { return name.ends_with(".json"); }

/// The places that differ, each with both values.
std::string json_details(const std::string& a, const std::string& b) {
  if (nests_deeper(a) || nests_deeper(b))
    return fmt::format("one of them is nested more than {} deep", kJsonDepthMax);
  const Json recorded = Json::parse(a, nullptr, false), again = Json::parse(b, nullptr, false);
  if (recorded.is_discarded() || again.is_discarded()) return "one of them is no JSON";
  std::vector<std::string> places;
  std::size_t more = 0;
  for (const Json& step : Json::diff(recorded, again)) {
    if (places.size() == kKeysShown) {
      ++more;
      continue;
    }
    const std::string path = step.at("path");
    const auto value_in = [&](const Json& of) {
      const Json::json_pointer place(path);
      return of.contains(place) ? of.at(place).dump() : "nothing";
    };
    places.push_back(fmt::format("{} is {}, was {}", path, value_in(again), value_in(recorded)));
  }
  if (places.empty()) return "the same values in other words";
  return fmt::format("{}{}", fmt::join(places, "; "), more ? fmt::format("; and {} more", more) : "");
}

/// The first line of text that differs.
std::string text_details(const std::string& a, const std::string& b) {
  const auto [at, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto line = 1 + std::count(a.begin(), at, '\n');
  return fmt::format("from byte {}, line {}, on", at - a.begin() + 1, line);
}

}  // namespace

std::vector<std::string> compared_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_directory() && name != kTimingFile && name != kManifest) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<ResultsDifference> compare_results(const fs::path& recorded, const fs::path& again) {
  std::set<std::string> names;
  for (const fs::path& folder : {recorded, again})
    for (const std::string& name : compared_files(folder)) names.insert(name);
  std::vector<ResultsDifference> differences;
  for (const std::string& name : names) {
    if (!is_file(again / name))
      differences.push_back({name, "it is no longer written"});
    else if (!is_file(recorded / name))
      differences.push_back({name, "it was not written then"});
    else if (const auto a = read_file(recorded / name), b = read_file(again / name); a != b)
      differences.push_back({name, is_json(name) ? json_details(a, b) : text_details(a, b)});
  }
  return differences;
}

}  // namespace understudy::report
