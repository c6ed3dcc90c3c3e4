#include "core/yaml/changed_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"

namespace understudy {
namespace {

InputError bad(const std::string& word, const std::string& why) {
  return InputError(fmt::format("'{}': {}; changed values are told as FILE{{key: value, ...}}", word, why));
}

/// What would end the value, or make the word another path.
bool plain(const std::string& text) {
  return !text.empty() && text.find_first_of("/{}[],:'\"#\n\\") == std::string::npos;
}

}  // namespace

std::string ChangedFile::braces() const {
  std::string text;
  for (const auto& [key, value] : changes)
    text += fmt::format("{}{}: {}", text.empty() ? "{" : ", ", key, value);
  return text.empty() ? text : text + "}";
}

ChangedFile changed_file(const std::string& word) {
  const std::size_t begin = word.rfind('{');
  if (begin == std::string::npos || !word.ends_with('}')) return {word, {}};
  ChangedFile changed{word.substr(0, begin), {}};
  try {
    const YAML::Node map = YAML::Load(word.substr(begin));
    if (!map.IsMap()) throw bad(word, "no values in the braces");
    for (const auto& entry : map) {
      if (!entry.first.IsScalar() || !entry.second.IsScalar())
        throw bad(word, "a value is a number or a word");
      const std::string key = entry.first.Scalar(), value = entry.second.Scalar();
      if (!plain(key) || !plain(value))
        throw bad(word, fmt::format("'{}: {}' is no key and value", key, value));
      for (const auto& [other, ignored] : changed.changes)
        if (other == key) throw bad(word, fmt::format("{} is changed twice", key));
      changed.changes.emplace_back(key, value);
    }
  } catch (const YAML::Exception& error) {
    throw bad(word, error.msg);
  }
  return changed;
}

std::string with_change(const std::string& word, const std::string& key, const std::string& value) {
  ChangedFile changed = changed_file(word);
  const auto known = std::find_if(changed.changes.begin(), changed.changes.end(),
                                  [&key](const ChangedValue& change) { return change.first == key; });
  if (known == changed.changes.end())
    changed.changes.emplace_back(key, value);
  else
    known->second = value;
  return changed_file(changed.file + changed.braces()).file + changed.braces();
}

}  // namespace understudy
