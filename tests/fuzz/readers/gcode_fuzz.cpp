// Bytes as a program, in every dialect, as they are and with lines that cannot be read passed over.
#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

void read(const std::string& text, const toolpath::GcodeOptions& options, bool& accepted) {
  toolpath::Program program;
  accepted =
      accepts(text.size(), "a.gcode", [&] { program = toolpath::parse_gcode(text, "a.gcode", options); });
  if (accepted) check_program(program, options);
}

void read_passing_over(const std::string& text, toolpath::GcodeOptions options, bool accepted) {
  std::vector<toolpath::PassedOver> lines;
  options.passed_over = &lines;
  bool read_on = false;
  read(text, options, read_on);
  require(read_on || !accepted, "refused where lines may be passed over, accepted where none may");
  if (!read_on) return;
  require(lines.empty() == accepted, "lines are passed over exactly where the program is refused without");
  require(lines.size() <= static_cast<std::size_t>(toolpath::kMostPassedOver), "too many are passed over");
  for (const toolpath::PassedOver& line : lines) {
    require(line.line > 0 && line.last_line >= line.line, "a line that is passed over has its place");
    require(!line.why.empty() && line.filament >= 0, "and a reason");
    require_finite(line.filament, "filament of lines that are passed over");
  }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string text(fuzz::text_of(data, size));
  for (const fuzz::Dialect& dialect : fuzz::dialects()) {
    bool accepted = false;
    fuzz::read(text, dialect.options, accepted);
    fuzz::read_passing_over(text, dialect.options, accepted);
  }
  return 0;
}
