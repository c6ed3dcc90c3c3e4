#include "core/yaml/yaml_text.h"

#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

namespace understudy {
namespace {

constexpr std::size_t kTextMax = 16'000'000;   // [bytes]
constexpr std::size_t kValuesMax = 1'000'000;  // some 0.5 kB each
constexpr std::size_t kWordMax = 64;           // [characters] that count as one value

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

/// Counts values without keeping them: words, lists and maps, for each alias those that it names once more. A
/// document of hundreds of bytes can name more of them than memory holds.
class ValueCount final : public YAML::EventHandler {
 public:
  explicit ValueCount(const std::string& file) : file_(file) {}

  void OnDocumentStart(const YAML::Mark&) override { count_ = 0, named_.clear(); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& at, YAML::anchor_t anchor) override { add(at, 1), named_[anchor] = 1; }
  void OnScalar(const YAML::Mark& at, const std::string&, YAML::anchor_t anchor,
                const std::string& word) override {
    const std::size_t values = 1 + word.size() / kWordMax;
    add(at, values), named_[anchor] = values;
  }
  void OnAlias(const YAML::Mark& at, YAML::anchor_t anchor) override {
    const auto named = named_.find(anchor);
    if (named == named_.end())
      throw InputError(place_of(at, file_), "an alias stands within the value that it names");
    add(at, named->second);
  }
  void OnSequenceStart(const YAML::Mark& at, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(at, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& at, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(at, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  void add(const YAML::Mark& at, std::size_t values) {
    count_ += values;
    if (count_ > kValuesMax)
      throw InputError(place_of(at, file_),
                       fmt::format("the file holds more than {} values, those that aliases repeat among them "
                                   "(docs/limits.md)",
                                   kValuesMax));
  }
  void begin(const YAML::Mark& at, YAML::anchor_t anchor) {
    open_.push_back({anchor, count_});
    add(at, 1);
  }
  void end() {
    named_[open_.back().anchor] = count_ - open_.back().before;
    open_.pop_back();
  }

  struct Open {
    YAML::anchor_t anchor;
    std::size_t before;
  };
  const std::string& file_;
  std::size_t count_ = 0;
  std::vector<Open> open_;                       // lists and maps that have not ended
  std::map<YAML::anchor_t, std::size_t> named_;  // how many values an anchor names
};

/// 0, 1, or 2 for more. Where a bracket is closed that was not opened, yaml-cpp 0.7 finds documents without
/// end, and YAML::LoadAll takes all memory.
int documents_in(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  ValueCount handler(file);
  int count = 0;
  while (count < 2 && parser.HandleNextDocument(handler)) ++count;
  return count;
}

}  // namespace

void check_yaml_text(const std::string& text, const std::string& file) {
  if (text.size() > kTextMax)
    throw InputError({file, 0, 0}, fmt::format("the file has {} bytes, more than {} (docs/limits.md)",
                                               text.size(), kTextMax));
  check_characters(text, file);
  const int documents = documents_in(text, file);
  if (documents == 0) throw InputError({file, 0, 0}, "the file is empty");
  if (documents > 1)
    throw InputError(
        {file, 0, 0},
        fmt::format(
            "the file holds {} documents, 1 is allowed (a bracket that is closed twice ends one, too)",
            documents));
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

}  // namespace understudy
