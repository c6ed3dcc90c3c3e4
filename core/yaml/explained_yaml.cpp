#include "core/yaml/explained_yaml.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"

namespace understudy {
namespace {

constexpr std::size_t kCommentColumn = 46;

/// The comments of a text by line. Those that stand alone go before the next key, the others beside the first
/// key of their line.
class Comments {
 public:
  explicit Comments(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 0; std::getline(lines, line); ++number) {
      const std::size_t begin = begin_of(line);
      if (begin == std::string::npos) continue;
      const bool alone = line.find_first_not_of(" \t") == begin;
      std::string comment = line.substr(line.find_first_not_of("# \t", begin) == std::string::npos
                                            ? line.size()
                                            : line.find_first_not_of("# \t", begin));
      if (alone && comment.starts_with("yaml-language-server"))
        continue;  // names a file that may not be there
      (alone ? alone_ : beside_)[number] = std::move(comment);
    }
  }
  /// What stands alone before this line, each once.
  std::vector<std::string> before(int line) {
    std::vector<std::string> found;
    while (!alone_.empty() && alone_.begin()->first < line) {
      found.push_back(std::move(alone_.begin()->second));
      alone_.erase(alone_.begin());
    }
    return found;
  }
  std::string beside(int line) {
    const auto found = beside_.find(line);
    if (found == beside_.end()) return {};
    std::string comment = std::move(found->second);
    beside_.erase(found);
    return comment;
  }

 private:
  static std::size_t begin_of(const std::string& line) {
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (quote) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) {
        return i;
      }
    }
    return std::string::npos;
  }

  std::map<int, std::string> alone_, beside_;
};

using Schemas = std::vector<const MapSchema*>;

/// What the variants say of a key: the first with words, and the maps below all of them.
struct Known {
  std::string about, unit;
  Schemas maps;
};

Known known_of(const Schemas& schemas, const std::string& key) {
  Known known;
  for (const MapSchema* schema : schemas)
    for (const MapVariant& variant : schema->variants)
      for (const KeySchema& k : variant.keys) {
        if (k.key != key) continue;
        if (known.about.empty()) known.about = k.about, known.unit = k.unit;
        for (const MapSchema& map : k.maps) known.maps.push_back(&map);
      }
  return known;
}

std::string one_line(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter << YAML::Flow << node;
  std::string text = emitter.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

class Writer {
 public:
  Writer(const std::string& text, const std::function<std::string(const std::string&)>& mark)
      : comments_(text), mark_(mark) {}

  void map(const YAML::Node& node, const Schemas& schemas, const std::string& path, const std::string& indent,
           const std::string& first_indent) {
    std::string lead = first_indent;
    for (const auto& entry : node) {
      const std::string key = entry.first.Scalar();
      const std::string here = path.empty() ? key : path + "." + key;
      const Known known = known_of(schemas, key);
      const int line = entry.first.Mark().line;
      if (path.empty() && !out_.empty() && entry.second.IsMap()) out_ += "\n";
      for (const std::string& comment : comments_.before(line)) out_ += indent + "# " + comment + "\n";
      this->entry(entry.second, lead + key + ":", comment_of(known, here, line), known, here, indent);
      lead = indent;
    }
  }
  std::string text() && { return std::move(out_); }

 private:
  std::string comment_of(const Known& known, const std::string& path, int line) {
    std::string comment = known.about;
    const auto add = [&](const std::string& more) {
      if (!more.empty()) comment += (comment.empty() ? "" : "; ") + more;
    };
    add(known.unit);
    add(comments_.beside(line));
    add(mark_(path));
    return comment;
  }
  void line(const std::string& text, const std::string& comment) {
    out_ += comment.empty() ? text + "\n" : fmt::format("{:<{}} # {}\n", text, kCommentColumn, comment);
  }
  void entry(const YAML::Node& value, const std::string& key, const std::string& comment, const Known& known,
             const std::string& path, const std::string& indent) {
    if (value.IsMap()) {
      line(key, comment);
      map(value, known.maps, path, indent + "  ", indent + "  ");
    } else if (value.IsSequence() && value.size() > 0 && value[0].IsMap()) {
      line(key, comment);
      for (const YAML::Node& item : value) map(item, known.maps, path, indent + "    ", indent + "  - ");
    } else {
      line(key + " " + one_line(value), comment);
    }
  }

  Comments comments_;
  const std::function<std::string(const std::string&)>& mark_;
  std::string out_;
};

}  // namespace

std::string explained_yaml(const std::string& text, const MapSchema& schema,
                           const std::function<std::string(const std::string&)>& mark) {
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap()) throw InputError("is no YAML map");
    Writer writer(text, mark);
    writer.map(root, {&schema}, "", "", "");
    return std::move(writer).text();
  } catch (const YAML::Exception& e) {
    throw InputError(std::string("is no YAML: ") + e.what());
  }
}

}  // namespace understudy
