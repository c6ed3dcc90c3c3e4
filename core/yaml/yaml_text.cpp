#include "core/yaml/yaml_text.h"

#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

namespace understudy {
namespace {

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

}  // namespace

void check_yaml_text(const std::string& text, const std::string& file) {
  if (text.size() > kTextMax)
    throw InputError({file, 0, 0}, fmt::format("the file has {} bytes, more than {} (docs/limits.md)",
                                               text.size(), kTextMax));
  check_characters(text, file);
  const int documents = documents_in(text);
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
