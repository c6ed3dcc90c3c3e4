// Bytes as a program, in every dialect.
#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string text(fuzz::text_of(data, size));
  for (const fuzz::Dialect& dialect : fuzz::dialects()) {
    toolpath::Program program;
    if (fuzz::accepts(size, "a.gcode",
                      [&] { program = toolpath::parse_gcode(text, "a.gcode", dialect.options); }))
      fuzz::check_program(program, dialect.options);
  }
  return 0;
}
