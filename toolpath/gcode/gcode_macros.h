// Macros of Klipper's configuration, for programs that call START_PRINT and the like.
//
// Of a file, the sections [gcode_macro NAME] and of these the key `gcode` are read. Of Jinja, lines may have
// {params.NAME}, {params.NAME|default(VALUE)}, {NAME} after {% set NAME = ... %} of such a value, and the
// filters `int` and `float` (Klipper, "Command templates"). Everything else of Jinja is refused where the
// macro is called.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::toolpath {

struct MacroLine {
  std::string text;
  int number = 0;  ///< of the macros' file, from 1
};

class GcodeMacros {
 public:
  const std::string& file() const { return file_; }
  /// Whether a line that begins with this command, upper case, calls a macro.
  bool has(const std::string& command) const { return macros_.contains(command); }
  /// The lines of the macro `command`, which has(), with the parameters of `call` ("START_PRINT BED=60",
  /// "M600 X1") in place. Throws InputError with the place in the macros' file.
  std::vector<MacroLine> expand(const std::string& command, std::string_view call) const;

  /// Throws InputError with file and line for a section that is none, or a macro that is there twice.
  static GcodeMacros parse(const std::string& text, const std::string& file);
  static GcodeMacros read(const std::filesystem::path& path);

 private:
  std::string file_;
  std::map<std::string, std::vector<MacroLine>> macros_;
};

}  // namespace understudy::toolpath
