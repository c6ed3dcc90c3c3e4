#include <algorithm>
#include <string_view>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/take_line.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_line_reader.h"

namespace understudy::toolpath {
namespace {

void check_anything_is_left(const Program& program, const GcodeOptions& options, bool empty) {
  const auto prints = [](const Step& step) { return step.kind == StepKind::print; };
  const auto printed = [](const PassedOver& lines) { return lines.filament > 0 || !lines.filament_known; };
  const bool moves_left = std::ranges::any_of(program.steps, moves);
  if (options.passed_over != nullptr && !options.passed_over->empty() &&
      (!moves_left ||
       (std::ranges::any_of(*options.passed_over, printed) && std::ranges::none_of(program.steps, prints))))
    refuse_passed_over(program.file, *options.passed_over);
  if (moves_left || (options.refused != nullptr && options.refused->lines > 0)) return;
  throw InputError(Place{program.file},
                   empty ? "empty file, at least 1 move is needed" : "0 moves, at least 1 is needed");
}

}  // namespace

Program parse_gcode(const std::string& text, const std::string& file, const GcodeOptions& options) {
  Program program;
  program.file = file;
  program.sha256 = sha256_hex(text);
  program.steps.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  GcodeLineReader reader(file, options, program.steps);
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark of some editors
  for (int line = 1; !rest.empty(); ++line) reader.read(take_line(rest), line);
  reader.finish();
  check_anything_is_left(program, options, text.empty());
  return program;
}

Program read_gcode(const std::filesystem::path& path, const GcodeOptions& options) {
  return parse_gcode(read_file(path), path.string(), options);
}

}  // namespace understudy::toolpath
