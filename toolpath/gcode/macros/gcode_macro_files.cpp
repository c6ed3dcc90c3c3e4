// Klipper's configuration, with the files that it includes, to macros.
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/files_named.h"
#include "core/file/outside.h"
#include "core/file/read_file.h"
#include "core/text/trimmed.h"
#include "toolpath/gcode/macros/gcode_macro_text.h"
#include "toolpath/gcode/macros/gcode_macros.h"

namespace understudy::toolpath {
namespace fs = std::filesystem;
using namespace macro_text;

namespace {

constexpr std::string_view kMacro = "gcode_macro", kInclude = "include";
constexpr std::size_t kMostFiles = 100;  // docs/limits.md

/// "gcode_macro NAME" -> NAME; nothing for sections of another kind.
std::optional<std::string_view> name_in(std::string_view section, std::string_view kind) {
  if (!section.starts_with(kind) ||
      (section.size() > kind.size() && !macro_text::is_blank(section[kind.size()])))
    return std::nullopt;
  return trimmed(section.substr(kind.size()));
}

}  // namespace

class MacroFiles {
 public:
  MacroFiles(GcodeMacros& macros, bool includes) : macros_(macros), includes_(includes) {
    macros_.files_.clear();
  }

  void read(const fs::path& path) {
    if (macros_.files_.size() == kMostFiles)
      throw InputError(Place{path.string()}, fmt::format("more than {} files are included", kMostFiles));
    const std::string text = read_file(path);
    open_.push_back(fs::weakly_canonical(path));
    if (text.size() > bytes_left_)
      throw InputError(Place{path.string()},
                       fmt::format("more than {} bytes in all that is included", kMacroFilesMax));
    bytes_left_ -= text.size();
    parse(text, path.string());
    open_.pop_back();
  }

  void parse(std::string_view text, const std::string& file) {
    macros_.files_.push_back(file);
    const Section outer = std::exchange(at_, {macros_.files_.size() - 1, false, false, nullptr, false});
    for (int number = 1; !text.empty(); ++number) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      add(text.substr(0, end), number);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    at_ = outer;
  }

 private:
  /// Where a file is being read.
  struct Section {
    std::size_t file = 0;
    bool begun = false, in_gcode = false;
    std::vector<MacroLine>* macro = nullptr;  // null: in a section of another kind
    bool replaces = false;                    // what another file has of it
  };

  const std::string& file() const { return macros_.files_[at_.file]; }
  [[noreturn]] void fail(int number, const std::string& message) const {
    throw InputError(Place{file(), number}, message);
  }

  void add(std::string_view line, int number) {
    line = line.substr(0, line.find('#'));
    const std::string_view words = trimmed(line);
    if (words.empty() || words.front() == ';') return;
    if (line.front() == '[')
      begin_section(words, number);
    else if (macro_text::is_blank(line.front()))
      go_on(words, number);
    else
      begin_key(words, number);
  }

  void begin_section(std::string_view words, int number) {
    if (words.back() != ']') fail(number, fmt::format("'{}': the section has no ']'", shown(words)));
    const std::string_view section = words.substr(1, words.size() - 2);
    at_ = {at_.file, true, false, nullptr, false};
    if (const auto name = name_in(section, kInclude); name && includes_) include(*name, number);
    const auto name = name_in(section, kMacro);
    if (!name) return;
    if (name->empty() ||
        !std::all_of(name->begin(), name->end(), [](char c) { return is_name(c) || c == '.'; }))
      fail(number, fmt::format("'{}': a macro's name has letters, digits and '_'", shown(words)));
    const auto [entry, is_new] = macros_.macros_.try_emplace(upper(*name));
    std::size_t& from = file_of_[entry->first];
    if (!is_new && from == at_.file) fail(number, fmt::format("'{}' is there a second time", entry->first));
    from = at_.file;
    at_.macro = &entry->second;
    at_.replaces = !is_new;
  }

  void include(std::string_view name, int number) {
    const std::vector<fs::path> files = files_named(fs::path(file()).parent_path(), std::string(name));
    const bool is_pattern = name.find_first_of("*?[") != std::string_view::npos;
    if (name.empty() || (files.empty() && !is_pattern))
      fail(number, fmt::format("[include {}]: there is no such file", shown(name)));
    for (const fs::path& path : files) {
      if (!may_be_named_from(open_.front().parent_path(), path))
        fail(number, fmt::format("[include {}] lies outside the folder of {}: copy it there, or set {}=1",
                                 shown(name), macros_.files_.front(), kAllowOutside));
      if (std::ranges::count(open_, fs::weakly_canonical(path)) > 0)
        fail(number, fmt::format("[include {}] includes itself", shown(name)));
      read(path);
    }
  }

  void begin_key(std::string_view words, int number) {
    const std::size_t end = words.find_first_of(":=");
    if (!at_.begun || end == std::string_view::npos)
      fail(number, fmt::format("'{}' is no [section] and no 'key: value' of one", shown(words)));
    at_.in_gcode = at_.macro != nullptr && trimmed(words.substr(0, end)) == "gcode";
    if (at_.in_gcode && at_.replaces) at_.macro->clear();
    if (const std::string_view value = trimmed(words.substr(end + 1)); at_.in_gcode && !value.empty())
      go_on(value, number);
  }

  void go_on(std::string_view words, int number) {
    if (at_.in_gcode) at_.macro->push_back({std::string(words.substr(0, words.find(';'))), number, at_.file});
  }

  GcodeMacros& macros_;
  bool includes_;
  std::size_t bytes_left_ = kMacroFilesMax;
  std::vector<fs::path> open_;                  // files that are being read, the outermost first
  std::map<std::string, std::size_t> file_of_;  // of macros
  Section at_;
};

GcodeMacros GcodeMacros::parse(const std::string& text, const std::string& file) {
  GcodeMacros result;
  MacroFiles(result, false).parse(text, file);
  return result;
}

GcodeMacros GcodeMacros::read(const fs::path& path) {
  GcodeMacros result;
  MacroFiles(result, true).read(path);
  return result;
}

}  // namespace understudy::toolpath
