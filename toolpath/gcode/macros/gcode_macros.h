// Macros of Klipper's configuration, for programs that call START_PRINT and the like.
//
// Of a file, the sections [gcode_macro NAME] and of these the key `gcode` are read, and [include FILE]. Of
// Jinja, lines may have {params.NAME}, {params.NAME|default(VALUE)}, {NAME} after {% set NAME = ... %} of
// such a value, and the filters `int` and `float` (Klipper, "Command templates"). Everything else of Jinja is
// refused where the macro is called.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace understudy::toolpath {

constexpr std::size_t kGcodeLineMax = 65'536;       ///< [bytes], of G-code; docs/limits.md
constexpr std::size_t kMacroFilesMax = 16'000'000;  ///< [bytes], of all files; docs/limits.md

/// What the macros of one program may yet make; docs/limits.md.
struct MacroBudget {
  std::size_t lines = 100'000;
  std::size_t bytes = 64'000'000;
};

struct MacroLine {
  std::string text;
  int number = 0;        ///< of its file, from 1
  std::size_t file = 0;  ///< of GcodeMacros::files()
};

class GcodeMacros {
 public:
  const std::string& file() const { return files_.front(); }
  /// The file itself, then those that it includes, in the order in which they were read.
  const std::vector<std::string>& files() const { return files_; }
  /// Whether a line that begins with this command, upper case, calls a macro.
  bool has(const std::string& command) const { return macros_.contains(command); }
  /// The lines of the macro `command`, which has(), with the parameters of `call` ("START_PRINT BED=60",
  /// "M600 X1") in place; they are taken from `left`. Throws InputError with the place in the macros' file,
  /// also where too little is left, or a line has more than kGcodeLineMax with its values.
  std::vector<MacroLine> expand(const std::string& command, std::string_view call, MacroBudget& left) const;

  /// Throws InputError with file and line for a section that is none, or a macro that is there twice. What
  /// the text includes is left out.
  static GcodeMacros parse(const std::string& text, const std::string& file);
  /// With [include FILE], whose name may have * and ?, counted from the folder of the file that names it. Of
  /// a macro in several files the last counts, as in Klipper. Throws InputError for a file that is not there,
  /// that includes itself, or that lies neither in the folder of `path` nor below (core/file/outside.h), and
  /// for files of more than kMacroFilesMax together.
  static GcodeMacros read(const std::filesystem::path& path);

 private:
  friend class MacroFiles;
  std::vector<std::string> files_{""};
  std::map<std::string, std::vector<MacroLine>> macros_;
};

/// The parameters of a call, by name in upper case: "BED=60 NAME="a b"", or of a letter with a number, X10
/// Y5. Throws InputError at `place`.
std::map<std::string, std::string> call_parameters(const std::string& command, std::string_view call,
                                                   const Place& place);

}  // namespace understudy::toolpath
