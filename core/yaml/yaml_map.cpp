#include "core/yaml/yaml_map.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "core/units.h"
#include "core/yaml/schema_recording.h"

namespace understudy {
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
    Unit{"_mrad", " mrad", 1e-3},
    Unit{"_permille", " permille", 1e-3},
    Unit{"_percent", " percent", 1e-2},
    Unit{"_arcmin", " arcmin", kDegree / 60},
    Unit{"_deg", " deg", kDegree},
    Unit{"_hz", " Hz", 1},
    Unit{"_n", " N", 1},
    Unit{"_kg", " kg", 1},
    Unit{"_ms", " ms", 1e-3},
    Unit{"_s", " s", 1},
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

constexpr std::size_t kWordsToList = 12;
constexpr std::size_t kTextMax = 16'000'000;  // [bytes]

/// YAML allows no control characters (YAML 1.2, 5.1); yaml-cpp takes them for the end of the text, or worse.
void check_characters(const std::string& text, const std::string& file) {
  Place at{file, 1, 0};
  for (const char c : text) {
    ++at.column;
    if (c == '\n') ++at.line, at.column = 0;
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\r' && c != '\t') || byte == 0x7f)
      throw InputError(at, fmt::format("not YAML: the control character 0x{:02x}", byte));
  }
}

/// Hears of a document without keeping it.
class NoHandler final : public YAML::EventHandler {
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

/// 0, 1, or 2 for more. Where a bracket is closed that was not opened, yaml-cpp 0.7 finds documents without
/// end, and YAML::LoadAll takes all memory.
int documents_in(const std::string& text) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  NoHandler handler;
  int count = 0;
  while (count < 2 && parser.HandleNextDocument(handler)) ++count;
  return count;
}

/// An empty value's mark is where the next word of the file begins: errors about one name its key's place.
Place place_of(const YAML::Mark& mark, const std::string& file) {
  return mark.is_null() ? Place{file, 0, 0} : Place{file, mark.line + 1, mark.column + 1};
}

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "empty";
  return fmt::format("'{}'{}", node.Scalar(), node.Tag() == "!" ? " in quotes" : "");
}

std::string no_map(const std::string& path, const YAML::Node& node) {
  return fmt::format("{} is {}, where keys with values are expected", path.empty() ? "the file" : path,
                     kind_of(node));
}

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

KeySchema schema_of(const std::string& key, KeySchema::Type type, const char* about) {
  KeySchema schema;
  schema.key = key;
  schema.type = type;
  schema.about = about;
  return schema;
}

KeySchema number_schema(const std::string& key, KeySchema::Type type, Bounds bounds, const char* about) {
  KeySchema schema = schema_of(key, type, about);
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

YamlMap::YamlMap(const YAML::Node& node, std::string file, std::string path)
    : file_(std::move(file)), path_(std::move(path)), place_(place_of(node.Mark(), file_)) {
  if (!node.IsMap()) throw InputError(node.IsNull() ? Place{file_, 0, 0} : place_, no_map(path_, node));
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
  if (text.size() > kTextMax)
    throw InputError({file, 0, 0}, fmt::format("the file has {} bytes, more than {} (docs/limits.md)",
                                               text.size(), kTextMax));
  check_characters(text, file);
  try {
    const int documents = documents_in(text);
    if (documents == 0) throw InputError({file, 0, 0}, "the file is empty");
    if (documents > 1)
      throw InputError(
          {file, 0, 0},
          fmt::format(
              "the file holds {} documents, 1 is allowed (a bracket that is closed twice ends one, too)",
              documents));
    YamlMap map(YAML::Load(text), file, "");
    read(map);
    map.finish();
  } catch (const YAML::Exception& error) {
    throw InputError(place_of(error.mark, file), "not YAML: " + error.msg);
  }
}

MapSchema YamlMap::schema(const Read& read) {
  return explore([&read](SchemaRecording& recording) {
    YamlMap map(recording);
    read(map);
  });
}

Place YamlMap::place(const std::string& key) const {
  const auto found = key_places_.find(key);
  return found == key_places_.end() ? place_ : found->second;
}

std::string YamlMap::path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

void YamlMap::fail(const std::string& key, const std::string& message) const {
  throw InputError(place(key), message);
}

const YAML::Node* YamlMap::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  const auto found = values_.find(key);
  if (found != values_.end()) return found->second.get();
  if (first_missing_.empty()) first_missing_ = key;
  return nullptr;
}

void YamlMap::fail_unknown(const std::string& key) const {
  std::vector<std::string> absent;
  for (const std::string& known : known_)
    if (!values_.contains(known)) absent.push_back(known);
  std::string near = nearest_word(key, absent);
  if (near.empty()) near = nearest_word(key, known_);
  fail(key, fmt::format("unknown key '{}'{}", path(key),
                        near.empty() ? fmt::format("; known here: {}", fmt::join(known_, ", "))
                                     : fmt::format(", did you mean '{}'?", near)));
}

void YamlMap::finish() const {
  // By line, so that the first mistake of the file is the one that is reported.
  std::vector<std::pair<int, std::string>> unknown;
  for (const auto& [key, place] : key_places_)
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) unknown.emplace_back(place.line, key);
  if (!unknown.empty()) fail_unknown(std::min_element(unknown.begin(), unknown.end())->second);
  if (!complete()) throw InputError(place_, fmt::format("key '{}' is missing", path(first_missing_)));
}

void YamlMap::require(const std::string& key) {
  if (recording_ || values_.contains(key)) return;
  // A misspelt key explains a missing one.
  for (const auto& [present, place] : key_places_)
    if (edit_distance(present, key) <= 1 + static_cast<int>(key.size()) / 4 &&
        std::find(known_.begin(), known_.end(), present) == known_.end())
      fail_unknown(present);
  throw InputError(place_, fmt::format("key '{}' is missing", path(key)));
}

void YamlMap::refuse(const std::string& key, const std::string& why) const {
  if (values_.contains(key)) fail(key, why);
}

bool YamlMap::has(const std::string& key) {
  const std::size_t dot = key.find('.');
  if (recording_) {
    if (dot == std::string::npos) recording_->look_for(key);
    return recording_->decide(key, {kPresent, kAbsent}) == kPresent;
  }
  if (dot == std::string::npos) {
    known_.push_back(key);
    return values_.contains(key);
  }
  const auto outer = values_.find(key.substr(0, dot));
  if (outer == values_.end() || !outer->second->IsMap()) return false;
  const YAML::Node& below = *outer->second;  // const: looking does not add the key
  return below[key.substr(dot + 1)].IsDefined();
}

bool YamlMap::either(const std::string& question, bool actual) {
  return recording_ ? recording_->decide("#" + question, {"1", "0"}) == "1" : actual;
}

double YamlMap::to_number(const YAML::Node& node, const std::string& key, Bounds bounds) const {
  const Place place = node.IsNull() ? this->place(key) : place_of(node.Mark(), file_);
  const Unit unit = unit_of(key);
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

std::string YamlMap::text(const std::string& key, const char* about) { return word(key, {}, about); }

std::vector<std::string> YamlMap::texts(const std::string& key, const char* about) {
  if (recording_) {
    recording_->ask(schema_of(key, KeySchema::Type::list, about));  // without maps: of words
    return {};
  }
  std::vector<std::string> words;
  const YAML::Node* node = find(key);
  if (!node) return words;
  if (node->IsScalar()) return {node->Scalar()};
  if (!node->IsSequence() || node->size() == 0)
    fail(key, fmt::format("{} is {}, where a list of words is expected", path(key), kind_of(*node)));
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
    KeySchema schema = schema_of(key, KeySchema::Type::text, about);
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

void YamlMap::section(const std::string& key, const char* about, const Read& read) {
  if (recording_) {
    KeySchema schema = schema_of(key, KeySchema::Type::map, about);
    schema.maps = {YamlMap::schema(read)};
    recording_->ask(std::move(schema));
    return;
  }
  const YAML::Node* node = find(key);
  if (!node) return;
  if (node->IsNull()) fail(key, no_map(path(key), *node));
  YamlMap map(*node, file_, path(key));
  read(map);
  map.finish();
}

void YamlMap::list(const std::string& key, std::size_t count, const char* about, const ReadItem& read) {
  if (recording_) {
    KeySchema schema = schema_of(key, KeySchema::Type::list, about);
    schema.count = count;
    for (std::size_t i = 0; i < std::max<std::size_t>(count, 1); ++i)
      schema.maps.push_back(YamlMap::schema([&](YamlMap& item) { read(item, i); }));
    const auto& maps = schema.maps;
    if (std::all_of(maps.begin(), maps.end(), [&](const MapSchema& map) { return map == maps.front(); }))
      schema.maps.resize(1);
    recording_->ask(std::move(schema));
    return;
  }
  const YAML::Node* node = find(key);
  if (!node) return;
  if (!node->IsSequence() || node->size() == 0)
    fail(key, fmt::format("{} is {}, where a list with at least one entry is expected", path(key),
                          node->IsSequence() ? "an empty list" : kind_of(*node)));
  for (std::size_t i = 0; i < node->size(); ++i) {
    const std::string item = fmt::format("{}[{}]", path(key), i + 1);
    if ((*node)[i].IsNull()) fail(key, no_map(item, (*node)[i]));
    YamlMap map((*node)[i], file_, item);
    read(map, i);
    map.finish();
  }
}

}  // namespace understudy
