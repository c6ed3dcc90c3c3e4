#include "machine/yaml_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

struct Unit {
  std::string_view suffix;
  std::string_view name;
  double si;
};

// A suffix that ends in another stands before it.
constexpr std::array kUnits{
    Unit{"_n_per_um", " N/um", 1 / kMicrometre},
    Unit{"_nm_per_rad", " N m/rad", 1},
    Unit{"_newton_metre", " N m", 1},
    Unit{"_deg_per_s2", " deg/s^2", kDegree},
    Unit{"_mm_per_s2", " mm/s^2", kMillimetre},
    Unit{"_mm_per_s", " mm/s", kMillimetre},
    Unit{"_deg_per_s", " deg/s", kDegree},
    Unit{"_m_per_s", " m/s", 1},
    Unit{"_kg_mm2", " kg mm^2", kMillimetre* kMillimetre},
    Unit{"_px_per_mm", " px/mm", 1 / kMillimetre},
    Unit{"_mm", " mm", kMillimetre},
    Unit{"_um", " um", kMicrometre},
    Unit{"_nm", " nm", 1e-9},
    Unit{"_arcmin", " arcmin", kDegree / 60},
    Unit{"_deg", " deg", kDegree},
    Unit{"_hz", " Hz", 1},
    Unit{"_n", " N", 1},
    Unit{"_kg", " kg", 1},
    Unit{"_ms", " ms", 1e-3},
    Unit{"_px", " px", 1},
    Unit{"_levels", " grey levels", 1},
    Unit{"_electrons", " electrons", 1},
    Unit{"_kg_per_m3", " kg/m^3", 1},
    Unit{"_j_per_kg_k", " J/(kg K)", 1},
    Unit{"_w_per_m_k", " W/(m K)", 1},
    Unit{"_gpa", " GPa", 1e9},
    Unit{"_k", " K", 1},
    Unit{"_c", " C", 1},  // the zero of the scale is the reader's to shift
};

Unit unit_of(std::string_view key) {
  for (const Unit& unit : kUnits)
    if (key.ends_with(unit.suffix)) return unit;
  return {"", "", 1};
}

Place place_of(const YAML::Mark& mark, const std::string& file) {
  return mark.is_null() ? Place{file, 0, 0} : Place{file, mark.line + 1, mark.column + 1};
}

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "empty";
  return fmt::format("'{}'", node.Scalar());
}

}  // namespace

YamlMap::YamlMap(const YAML::Node& node, std::string file, std::string path)
    : file_(std::move(file)), path_(std::move(path)), place_(place_of(node.Mark(), file_)) {
  if (!node.IsMap())
    throw InputError(place_, fmt::format("{} is {}, where keys with values are expected",
                                         path_.empty() ? "the file" : path_, kind_of(node)));
  for (const auto& entry : node) {
    const Place place = place_of(entry.first.Mark(), file_);
    if (!entry.first.IsScalar()) throw InputError(place, "a key is " + kind_of(entry.first) + ", not a name");
    const std::string key = entry.first.Scalar();
    if (values_.contains(key))
      throw InputError(
          place, fmt::format("{} is given twice, first in line {}", this->path(key), key_places_[key].line));
    values_[key] = std::make_shared<YAML::Node>(entry.second);
    key_places_[key] = place;
  }
}

void YamlMap::read_text(const std::string& text, const std::string& file, const Read& read) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) throw InputError({file, 0, 0}, "the file is empty");
    if (documents.size() > 1)
      throw InputError({file, 0, 0},
                       fmt::format("the file holds {} documents, 1 is allowed", documents.size()));
    YamlMap map(documents.front(), file, "");
    read(map);
    map.finish();
  } catch (const YAML::Exception& error) {
    throw InputError(place_of(error.mark, file), "not YAML: " + error.msg);
  }
}

Place YamlMap::place() const { return place_; }

Place YamlMap::place(const std::string& key) const {
  const auto found = key_places_.find(key);
  return found == key_places_.end() ? place_ : found->second;
}

std::string YamlMap::path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

const YAML::Node* YamlMap::find(const std::string& key) {
  known_.push_back(key);
  const auto found = values_.find(key);
  if (found != values_.end()) return found->second.get();
  if (first_missing_.empty()) first_missing_ = key;
  return nullptr;
}

void YamlMap::finish() const {
  // By line, so that the first mistake of the file is the one that is reported.
  std::vector<std::pair<int, std::string>> unknown;
  for (const auto& [key, place] : key_places_)
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) unknown.emplace_back(place.line, key);
  if (!unknown.empty()) {
    const std::string key = std::min_element(unknown.begin(), unknown.end())->second;
    std::vector<std::string> absent;
    for (const std::string& known : known_)
      if (!values_.contains(known)) absent.push_back(known);
    std::string near = nearest_word(key, absent);
    if (near.empty()) near = nearest_word(key, known_);
    throw InputError(place(key),
                     fmt::format("unknown key '{}'{}", path(key),
                                 near.empty() ? fmt::format("; known here: {}", fmt::join(known_, ", "))
                                              : fmt::format(", did you mean '{}'?", near)));
  }
  if (!complete()) throw InputError(place_, fmt::format("key '{}' is missing", path(first_missing_)));
}

double YamlMap::number(const YAML::Node& node, const std::string& key, Bounds bounds) const {
  const Place place = place_of(node.Mark(), file_);
  const Unit unit = unit_of(key);
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value))
    throw InputError(place, fmt::format("{} is {}, where a number{}{} is expected", path(key), kind_of(node),
                                        unit.name.empty() ? "" : " in", unit.name));
  if (!std::isfinite(value))
    throw InputError(place, fmt::format("{} is {}, not finite", path(key), node.Scalar()));
  if (value < bounds.low || value > bounds.high)
    throw InputError(place, fmt::format("{} is {}{}, outside {} to {}{}", path(key), value, unit.name,
                                        bounds.low, bounds.high, unit.name));
  return value;
}

bool YamlMap::has(const std::string& key) {
  known_.push_back(key);
  return values_.contains(key);
}

double YamlMap::quantity(const std::string& key, Bounds bounds) {
  const YAML::Node* node = find(key);
  return node ? number(*node, key, bounds) * unit_of(key).si : 0;
}

std::vector<double> YamlMap::quantities(const std::string& key, std::size_t count, Bounds bounds) {
  const YAML::Node* node = find(key);
  std::vector<double> values(count, 0);
  if (!node) return values;
  if (!node->IsSequence() || node->size() != count)
    throw InputError(
        place(key),
        fmt::format("{} is {}, where a list of {} numbers is expected", path(key),
                    node->IsSequence() ? fmt::format("a list of {}", node->size()) : kind_of(*node), count));
  for (std::size_t i = 0; i < count; ++i) values[i] = number((*node)[i], key, bounds) * unit_of(key).si;
  return values;
}

Vec3 YamlMap::vector(const std::string& key, Bounds bounds) {
  const std::vector<double> v = quantities(key, 3, bounds);
  return {v[0], v[1], v[2]};
}

int YamlMap::integer(const std::string& key, int low, int high) {
  const YAML::Node* node = find(key);
  if (!node) return 0;
  const double value = number(*node, key, {static_cast<double>(low), static_cast<double>(high)});
  if (value != std::floor(value))
    throw InputError(place_of(node->Mark(), file_),
                     fmt::format("{} is {}, not a whole number", path(key), value));
  return static_cast<int>(value);
}

std::string YamlMap::text(const std::string& key) {
  const YAML::Node* node = find(key);
  if (!node) return "";
  if (!node->IsScalar() || node->Scalar().empty())
    throw InputError(place(key), fmt::format("{} is {}, where text is expected", path(key), kind_of(*node)));
  return node->Scalar();
}

std::string YamlMap::word(const std::string& key, const std::vector<std::string>& allowed) {
  const std::string value = text(key);
  if (!values_.contains(key) || std::find(allowed.begin(), allowed.end(), value) != allowed.end())
    return value;
  throw InputError(place(key),
                   fmt::format("{} is '{}', not one of {}", path(key), value, fmt::join(allowed, ", ")));
}

void YamlMap::section(const std::string& key, const Read& read) {
  const YAML::Node* node = find(key);
  if (!node) return;
  YamlMap map(*node, file_, path(key));
  read(map);
  map.finish();
}

void YamlMap::list(const std::string& key, const Read& read) {
  const YAML::Node* node = find(key);
  if (!node) return;
  if (!node->IsSequence() || node->size() == 0)
    throw InputError(place(key), fmt::format("{} is {}, where a list is expected", path(key),
                                             node->IsSequence() ? "an empty list" : kind_of(*node)));
  for (std::size_t i = 0; i < node->size(); ++i) {
    YamlMap map((*node)[i], file_, fmt::format("{}[{}]", path(key), i + 1));
    read(map);
    map.finish();
  }
}

}  // namespace understudy::machine
