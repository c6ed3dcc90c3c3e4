#include "core/yaml/change_values.h"

#include <charconv>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace understudy {
namespace {

std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t dot; (dot = key.find('.', begin)) != std::string::npos; begin = dot + 1)
    parts.push_back(key.substr(begin, dot - begin));
  parts.push_back(key.substr(begin));
  return parts;
}

std::vector<std::string> names_in(const YAML::Node& list) {
  std::vector<std::string> names;
  for (const auto& item : list)
    if (item.IsMap() && item["name"] && item["name"].IsScalar()) names.push_back(item["name"].Scalar());
  return names;
}

class Way {
 public:
  Way(const std::string& key, std::string file) : key_(key), file_(std::move(file)) {}

  std::size_t index_in(const YAML::Node& list, const std::string& part) const {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (error == std::errc() && end == part.data() + part.size()) {
      if (number >= 1 && number <= list.size()) return number - 1;
      fail(fmt::format("item {} is outside 1..{}", part, list.size()));
    }
    const std::vector<std::string> names = names_in(list);
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].IsMap() && list[i]["name"] && list[i]["name"].Scalar() == part) return i;
    const std::string near = nearest_word(part, names);
    fail(fmt::format("no item of the list is named '{}'{}", part,
                     near.empty() ? fmt::format("; its items are 1..{}{}{}", list.size(),
                                                names.empty() ? "" : " or ", fmt::join(names, ", "))
                                  : fmt::format(", did you mean '{}'?", near)));
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(Place{file_, 0, 0}, fmt::format("{}: {}", key_, why));
  }

 private:
  const std::string& key_;
  std::string file_;
};

void change(YAML::Node root, const ChangedValue& value, const std::string& file) {
  const Way way(value.first, file);
  const std::vector<std::string> parts = parts_of(value.first);
  YAML::Node at = root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    if (parts[i].empty()) way.fail("a part between the dots is empty");
    if (at.IsSequence()) {
      const std::size_t index = way.index_in(at, parts[i]);
      if (last)
        at[index] = value.second;
      else
        at.reset(at[index]);
    } else if (at.IsMap()) {
      if (last) {
        at[parts[i]] = value.second;
      } else {
        const YAML::Node& looked = at;
        if (!looked[parts[i]].IsDefined() || looked[parts[i]].IsNull())
          at[parts[i]] = YAML::Node(YAML::NodeType::Map);
        at.reset(at[parts[i]]);
      }
    } else {
      way.fail(fmt::format("'{}' is below a value, where no key is", parts[i]));
    }
  }
}

/// Where the value of `key` stands in `root`; a node that is not defined where its whole section is missing.
YAML::Node standing(const YAML::Node& root, const std::string& key, const std::string& file) {
  const Way way(key, file);
  YAML::Node at = root;
  bool first = true;
  for (const std::string& part : parts_of(key)) {
    const YAML::Node& looked = at;
    if (at.IsSequence()) {
      at.reset(at[way.index_in(at, part)]);
    } else if (!at.IsMap()) {
      way.fail(fmt::format("'{}' is below a value, where no key is", part));
    } else if (looked[part].IsDefined()) {
      at.reset(at[part]);
    } else if (first) {
      return YAML::Node(YAML::NodeType::Undefined);
    } else {
      way.fail("does not stand in the file, so it cannot be written there: add it to a copy of the file");
    }
    first = false;
  }
  return at;
}

/// Lines of a section that was not there.
std::string section_of(const ChangedValue& value) {
  std::string lines, indent;
  for (const std::string& part : parts_of(value.first)) {
    lines += (lines.empty() ? "" : "\n") + indent + part + ":";
    indent += "  ";
  }
  return lines + " " + value.second + "\n";
}

std::string with_value(std::string text, const ChangedValue& value, const std::string& file) {
  const YAML::Node at = standing(YAML::Load(text), value.first, file);
  if (!at.IsDefined()) return text + (text.ends_with('\n') ? "" : "\n") + section_of(value);
  const auto begin = static_cast<std::size_t>(at.Mark().pos);
  const std::string before = at.IsScalar() ? at.Scalar() : "";
  if (before.empty() || text.compare(begin, before.size(), before) != 0)
    Way(value.first, file).fail("is no plain word or number in the file, so it cannot be changed there");
  return text.replace(begin, before.size(), value.second);
}

}  // namespace

std::string changed_text(const std::string& text, const ChangedFile& changed, const std::string& file) {
  std::string now = text;
  for (const ChangedValue& value : changed.changes) now = with_value(now, value, file);
  return now;
}

void change_values(YAML::Node& root, const ChangedFile& changed, const std::string& file) {
  for (const ChangedValue& value : changed.changes) change(root, value, file);
}

}  // namespace understudy
