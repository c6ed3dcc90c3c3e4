#include "core/strict_yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace understudy::rehearsal {
namespace {

template <typename T>
bool parse_whole(const std::string& text, T& value) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // from_chars knows no plus
  const char* begin = text.data() + (plus ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

}  // namespace

YAML::Node parse_yaml(const std::string& text, const std::string& file) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) throw InputError({file, 0, 0}, "the file is empty");
    if (documents.size() > 1)
      throw InputError({file, 0, 0},
                       "the file holds " + std::to_string(documents.size()) + " documents, not 1");
    return documents.front();
  } catch (const YAML::Exception& error) {
    throw InputError({file, error.mark.line + 1, error.mark.column + 1}, "not YAML: " + error.msg);
  }
}

StrictMap::StrictMap(const YAML::Node& node, std::string file, std::string what)
    : node_(node), file_(std::move(file)), what_(std::move(what)) {
  if (!node_.IsMap()) throw InputError(place(node_), what_ + " must be a mapping of keys to values");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar())
      throw InputError(place(entry.first), "a key of " + what_ + " must be a word");
    if (!seen.insert(entry.first.Scalar()).second)
      throw InputError(place(entry.first), quoted(entry.first.Scalar()) + " stands twice in " + what_);
  }
}

Place StrictMap::place(const YAML::Node& node) const { return {file_, node.Mark().line + 1, 0}; }

int StrictMap::line() const { return node_.Mark().line + 1; }

bool StrictMap::has(const std::string& key) {
  asked_.insert(key);
  return node_[key].IsDefined();
}

YAML::Node StrictMap::required(const std::string& key) {
  if (has(key)) return node_[key];
  // A misspelt key shows up as a missing one: name the stranger.
  for (const auto& entry : node_) {
    const std::string& present = entry.first.Scalar();
    if (!asked_.contains(present) && edit_distance(present, key) <= 1 + static_cast<int>(key.size()) / 4)
      throw InputError(place(entry.first), "unknown key " + quoted(present) + " in " + what_ +
                                               "; did you mean " + quoted(key) + "?");
  }
  throw InputError(place(node_), what_ + " lacks the key " + quoted(key));
}

void StrictMap::fail(const std::string& key, const std::string& message) const {
  for (const auto& entry : node_)
    if (entry.first.Scalar() == key) throw InputError(place(entry.first), message);
  throw InputError(place(node_), message);
}

YAML::Node StrictMap::scalar(const std::string& key) {
  const YAML::Node value = required(key);
  if (!value.IsScalar() || value.Scalar().empty())
    fail(key, quoted(key) + " of " + what_ + " needs one value");
  return value;
}

std::string StrictMap::text(const std::string& key) { return scalar(key).Scalar(); }

double StrictMap::to_number(const YAML::Node& node, const std::string& key) const {
  double value = 0;
  const bool plain = node.IsScalar() && node.Tag() != "!";  // "!": in quotes
  if (!plain || !parse_whole(node.Scalar(), value) || !std::isfinite(value))
    fail(key, quoted(key) + " of " + what_ + " must be a finite number" +
                  (node.IsScalar() ? ", not " + quoted(node.Scalar()) : ""));
  return value;
}

double StrictMap::number(const std::string& key) { return to_number(required(key), key); }

bool StrictMap::holds_number(const std::string& key) {
  double ignored = 0;
  const YAML::Node value = required(key);
  return value.IsScalar() && value.Tag() != "!" && parse_whole(value.Scalar(), ignored);
}

std::uint64_t StrictMap::whole_number(const std::string& key) {
  std::uint64_t value = 0;
  const YAML::Node node = scalar(key);
  if (!parse_whole(node.Scalar(), value))
    fail(key, quoted(key) + " of " + what_ + " must be a whole number from 0, not " + quoted(node.Scalar()));
  return value;
}

std::vector<double> StrictMap::numbers(const std::string& key, std::size_t count) {
  const YAML::Node list = required(key);
  if (!list.IsSequence() || list.size() != count)
    fail(key, quoted(key) + " of " + what_ + " must be a list of " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const auto& item : list) values.push_back(to_number(item, key));
  return values;
}

StrictMap StrictMap::map(const std::string& key, const std::string& what) {
  return {required(key), file_, what};
}

std::vector<StrictMap> StrictMap::list_of_maps(const std::string& key, const std::string& what) {
  const YAML::Node list = required(key);
  if (!list.IsSequence() || list.size() == 0)
    fail(key, quoted(key) + " of " + what_ + " must be a list with at least one entry");
  std::vector<StrictMap> maps;
  for (const auto& item : list) maps.emplace_back(item, file_, what);
  return maps;
}

std::string StrictMap::word(const std::string& key, const std::vector<std::string>& words) {
  const std::string value = text(key);
  if (std::find(words.begin(), words.end(), value) != words.end()) return value;
  const std::string nearest = nearest_word(value, words);
  std::string known;
  for (const std::string& w : words) known += (known.empty() ? "" : ", ") + w;
  fail(key, quoted(key) + " of " + what_ + " cannot be " + quoted(value) +
                (nearest.empty() ? "; it is one of " + known : "; did you mean " + quoted(nearest) + "?"));
}

void StrictMap::close() const {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (asked_.contains(key)) continue;
    const std::string nearest = nearest_word(key, asked_);
    throw InputError(place(entry.first),
                     "unknown key " + quoted(key) + " in " + what_ +
                         (nearest.empty() ? "" : "; did you mean " + quoted(nearest) + "?"));
  }
}

}  // namespace understudy::rehearsal
