// Bytes as Klipper's configuration, and behind a line "---" a program that calls its macros.
#include <algorithm>
#include <memory>

#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

namespace {

/// Macros may run 100 000 lines (docs/limits.md), at 20 us each under the sanitizers: as many steps of 1 ms.
constexpr std::size_t kMade = 2000;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string text(fuzz::text_of(data, size));
  const std::string kMark = "\n---\n";
  const std::size_t mark = std::min(text.find(kMark), text.size());
  toolpath::GcodeMacros macros;
  if (!fuzz::accepts(size, "m.cfg",
                     [&] { macros = toolpath::GcodeMacros::parse(text.substr(0, mark), "m.cfg"); }))
    return 0;
  toolpath::GcodeOptions options = fuzz::dialects().front().options;
  options.macros = std::make_shared<toolpath::GcodeMacros>(std::move(macros));
  const std::string program_text = text.substr(std::min(mark + kMark.size(), text.size()));
  toolpath::Program program;
  if (fuzz::accepts(
          size, "a.gcode", [&] { program = toolpath::parse_gcode(program_text, "a.gcode", options); },
          [] { return kMade; }))
    fuzz::check_program(program, options);
  return 0;
}
