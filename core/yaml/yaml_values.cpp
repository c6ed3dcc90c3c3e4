// Numbers, words and lists of a YamlMap.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/printable.h"
#include "core/yaml/key_unit.h"
#include "core/yaml/schema_recording.h"
#include "core/yaml/yaml_map.h"
#include "core/yaml/yaml_text.h"

namespace understudy {
namespace {

constexpr std::size_t kWordsToList = 12;

enum class Parse { number, not_finite, other };

template <typename Value>
Parse parse(const std::string& text, Value& value) {
  for (const char* word :
       {".nan", ".NaN", ".NAN", ".inf", "-.inf", "+.inf", ".Inf", "-.Inf", ".INF", "-.INF"})
    if (text == word) return Parse::not_finite;
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // from_chars knows no plus
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + (plus ? 1 : 0), end, value);
  if (rest != end || error == std::errc::invalid_argument) return Parse::other;
  if (error == std::errc::result_out_of_range) return Parse::not_finite;
  if constexpr (std::is_floating_point_v<Value>)
    if (!std::isfinite(value)) return Parse::not_finite;
  return Parse::number;
}

KeySchema number_schema(const std::string& key, KeySchema::Type type, Bounds bounds, const char* about) {
  KeySchema schema = key_schema(key, type, about);
  schema.bounds = bounds;
  const std::string_view unit = unit_of(key).name;
  schema.unit = unit.empty() ? unit : unit.substr(1);
  return schema;
}

std::string beyond(Bounds bounds, std::string_view unit) {
  if (bounds.high == Bounds().high) return fmt::format("below {}{}", bounds.low, unit);
  return fmt::format("outside {} to {}{}", bounds.low, bounds.high, unit);
}

}  // namespace

double YamlMap::to_number(const YAML::Node& node, const std::string& key, Bounds bounds) const {
  const Place place = node.IsNull() ? this->place(key) : place_of(node.Mark(), file_);
  const KeyUnit unit = unit_of(key);
  double value = 0;
  const Parse parsed = node.IsScalar() && node.Tag() != "!" ? parse(node.Scalar(), value) : Parse::other;
  if (parsed == Parse::other)
    throw InputError(place, fmt::format("{} is {}, where a number{}{} is expected", path(key), kind_of(node),
                                        unit.name.empty() ? "" : " in", unit.name));
  if (parsed == Parse::not_finite)
    throw InputError(place, fmt::format("{} is {}, not finite", path(key), node.Scalar()));
  if (value < bounds.low || value > bounds.high)
    throw InputError(place,
                     fmt::format("{} is {}{}, {}", path(key), value, unit.name, beyond(bounds, unit.name)));
  return value;
}

std::vector<double> YamlMap::to_numbers(const std::string& key, std::size_t count, Bounds bounds) {
  std::vector<double> values(count, 0);
  const YAML::Node* node = find(key);
  if (!node) return values;
  if (!node->IsSequence() || node->size() != count)
    fail(key,
         fmt::format("{} is {}, where a list of {} numbers is expected", path(key),
                     node->IsSequence() ? fmt::format("a list of {}", node->size()) : kind_of(*node), count));
  for (std::size_t i = 0; i < count; ++i) values[i] = to_number((*node)[i], key, bounds);
  return values;
}

double YamlMap::number(const std::string& key, Bounds bounds, const char* about) {
  if (recording_) {
    recording_->ask(number_schema(key, KeySchema::Type::number, bounds, about));
    return 0;
  }
  const YAML::Node* node = find(key);
  return node ? to_number(*node, key, bounds) : 0;
}

double YamlMap::quantity(const std::string& key, Bounds bounds, const char* about) {
  return number(key, bounds, about) * unit_of(key).si;
}

std::vector<double> YamlMap::numbers(const std::string& key, std::size_t count, Bounds bounds,
                                     const char* about) {
  if (!recording_) return to_numbers(key, count, bounds);
  KeySchema schema = number_schema(key, KeySchema::Type::numbers, bounds, about);
  schema.count = count;
  recording_->ask(std::move(schema));
  return std::vector<double>(count, 0);
}

std::vector<double> YamlMap::quantities(const std::string& key, std::size_t count, Bounds bounds,
                                        const char* about) {
  std::vector<double> values = numbers(key, count, bounds, about);
  for (double& value : values) value *= unit_of(key).si;
  return values;
}

Vec3 YamlMap::vector(const std::string& key, Bounds bounds, const char* about) {
  const std::vector<double> v = quantities(key, 3, bounds, about);
  return {v[0], v[1], v[2]};
}

int YamlMap::integer(const std::string& key, int low, int high, const char* about) {
  const Bounds bounds{static_cast<double>(low), static_cast<double>(high)};
  if (recording_) {
    recording_->ask(number_schema(key, KeySchema::Type::integer, bounds, about));
    return low;
  }
  const YAML::Node* node = find(key);
  if (!node) return 0;
  const double value = to_number(*node, key, bounds);
  if (value != std::floor(value))
    throw InputError(place_of(node->Mark(), file_),
                     fmt::format("{} is {}, not a whole number", path(key), value));
  return static_cast<int>(value);
}

std::uint64_t YamlMap::seed(const std::string& key, const char* about) {
  if (recording_) {
    recording_->ask(number_schema(key, KeySchema::Type::integer, {0, 0x1p64}, about));
    return 0;
  }
  std::uint64_t value = 0;
  const YAML::Node* node = find(key);
  if (node && (!node->IsScalar() || parse(node->Scalar(), value) != Parse::number))
    fail(key, fmt::format("{} is {}, where a whole number from 0 to 2^64 - 1 is expected", path(key),
                          kind_of(*node)));
  return value;
}

std::string YamlMap::name(const std::string& key, const char* about) {
  std::string name = text(key, about);
  // A file has none, but its escapes can make them.
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    fail(key, fmt::format("{} is '{}': a name is one line without control characters", path(key),
                          printable(name)));
  return name;
}

std::string YamlMap::text(const std::string& key, const char* about) { return word(key, {}, about); }

std::vector<std::string> YamlMap::texts(const std::string& key, const char* about) {
  if (recording_) {
    recording_->ask(key_schema(key, KeySchema::Type::list, about));  // without maps: of words
    return {};
  }
  std::vector<std::string> words;
  const YAML::Node* node = find(key);
  if (!node) return words;
  if (node->IsScalar()) return {node->Scalar()};
  if (!node->IsSequence() || node->size() == 0)
    fail(key, fmt::format("{} is {}, where a list of words is expected", path(key),
                          node->IsSequence() ? "an empty list" : kind_of(*node)));
  for (const auto& item : *node) {
    if (!item.IsScalar())
      fail(key, fmt::format("{} holds {}, where a word is expected", path(key), kind_of(item)));
    words.push_back(item.Scalar());
  }
  return words;
}

std::string YamlMap::word(const std::string& key, const std::vector<std::string>& allowed,
                          const char* about) {
  if (recording_) {
    KeySchema schema = key_schema(key, KeySchema::Type::text, about);
    schema.words = allowed;
    recording_->ask(std::move(schema));
    return allowed.empty() ? "" : recording_->decide(key, allowed);
  }
  const YAML::Node* node = find(key);
  if (!node) return "";
  if (!node->IsScalar() || node->Scalar().empty())
    fail(key, fmt::format("{} is {}, where text is expected", path(key), kind_of(*node)));
  if (!allowed.empty()) check_word(key, node->Scalar(), allowed);
  return node->Scalar();
}

void YamlMap::check_word(const std::string& key, const std::string& value,
                         const std::vector<std::string>& allowed) const {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return;
  const std::string near = nearest_word(value, allowed);
  fail(key, fmt::format("{} is '{}', not one of {}{}", path(key), value,
                        allowed.size() <= kWordsToList ? fmt::format("{}", fmt::join(allowed, ", "))
                                                       : fmt::format("the {} known ones", allowed.size()),
                        near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace understudy
