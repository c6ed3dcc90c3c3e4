#include "report/json_figures.h"

#include <set>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/json_depth.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using Figures = std::map<std::string, std::variant<double, std::string>>;

/// Of the items of a list, where every one is an object that begins with a word that no other has; else
/// empty.
std::vector<std::string> names_of(const Json& list) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const Json& item : list) {
    if (!item.is_object() || item.empty() || !item.front().is_string()) return {};
    names.push_back(item.front().get<std::string>());
    if (!taken.insert(names.back()).second) return {};
  }
  return names;
}

void gather(const Json& value, const std::string& name, Figures& figures) {
  const auto below = [&](const std::string& key) { return name.empty() ? key : name + "." + key; };
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) gather(item, below(key), figures);
  } else if (value.is_array()) {
    const std::vector<std::string> names = names_of(value);
    for (std::size_t i = 0; i < value.size(); ++i)
      gather(value[i], below(names.empty() ? std::to_string(i) : names[i]), figures);
  } else if (value.is_number()) {
    figures[name] = value.get<double>();
  } else if (value.is_string()) {
    figures[name] = value.get<std::string>();
  } else if (value.is_boolean()) {
    figures[name] = value.get<bool>() ? "true" : "false";
  }
}

}  // namespace

Figures json_figures(const std::string& text, const std::string& file) {
  Figures figures;
  try {
    if (nests_deeper(text)) throw InputError(file + ": is nested too deep");
    gather(Json::parse(text), "", figures);
  } catch (const Json::exception& error) {
    throw InputError(file + ": not JSON: " + error.what());
  }
  return figures;
}

}  // namespace understudy::report
