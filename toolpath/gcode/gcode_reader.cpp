#include <algorithm>
#include <string_view>

#include "core/digest.h"
#include "core/error.h"
#include "core/output_file.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_block.h"
#include "toolpath/gcode/gcode_lexer.h"
#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {

Program parse_gcode(const std::string& text, const std::string& file, const GcodeOptions& options) {
  Program program;
  program.file = file;
  program.sha256 = sha256_hex(text);
  GcodeState state(options);
  const Letters letters{options.rotary ? options.rotary->letters : "", options.extruder_letter};
  program.steps.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark of some editors
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    Block block(lex_line(rest.substr(0, end), file, line), file, line, letters);
    state.run(block, program.steps);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  for (const Step& step : program.steps)
    if (moves(step)) return program;
  throw InputError(Place{file},
                   text.empty() ? "empty file, at least 1 move is needed" : "0 moves, at least 1 is needed");
}

Program read_gcode(const std::filesystem::path& path, const GcodeOptions& options) {
  return parse_gcode(read_file(path), path.string(), options);
}

}  // namespace understudy::toolpath
