#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_block.h"
#include "toolpath/gcode/gcode_lexer.h"
#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kLineMax = 65'536;  // [bytes]; docs/limits.md

/// Up to a line feed, a carriage return, or both; a comment ends there, too.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  if (rest.starts_with("\r\n"))
    rest.remove_prefix(2);
  else if (!rest.empty())
    rest.remove_prefix(1);
  return line;
}

}  // namespace

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
    const std::string_view words = take_line(rest);
    if (words.size() > kLineMax)
      throw InputError(Place{file, line},
                       fmt::format("the line has {} bytes, more than {}", words.size(), kLineMax));
    Block block(lex_line(words, file, line), file, line, letters);
    state.run(block, program.steps);
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
