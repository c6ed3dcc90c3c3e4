#include "core/yaml/yaml_map.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/yaml/change_values.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/schema_recording.h"
#include "core/yaml/yaml_text.h"

namespace understudy {
namespace {

std::string no_map(const std::string& path, const YAML::Node& node) {
  return fmt::format("{} is {}, where keys with values are expected", path.empty() ? "the file" : path,
                     kind_of(node));
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
  try {
    check_yaml_text(text, file);
    YAML::Node root = YAML::Load(text);
    change_values(root, changed_file(file), file);
    YamlMap map(root, file, "");
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

void YamlMap::section(const std::string& key, const char* about, const Read& read) {
  if (recording_) {
    KeySchema schema = key_schema(key, KeySchema::Type::map, about);
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

void YamlMap::record_list(const std::string& key, const char* about, const MapSchema& item) {
  KeySchema schema = key_schema(key, KeySchema::Type::list, about);
  schema.maps.push_back(item);
  recording_->ask(std::move(schema));
}

void YamlMap::list(const std::string& key, std::size_t count, const char* about, const ReadItem& read) {
  if (recording_) {
    KeySchema schema = key_schema(key, KeySchema::Type::list, about);
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
