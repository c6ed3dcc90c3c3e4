// Bytes as the choices of a grammar: what it writes, the reader must accept.
#include <algorithm>

#include "tests/fuzz/gcode_grammar.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::size_t kind = size > 0 ? data[0] % fuzz::dialects().size() : 0;
  const fuzz::Dialect& dialect = fuzz::dialects()[kind];
  const std::string text =
      fuzz::grammatical_program({data + std::min<std::size_t>(size, 1), data + size}, dialect);
  try {
    fuzz::check_program(toolpath::parse_gcode(text, "a.gcode", dialect.options), dialect.options);
  } catch (const InputError& error) {
    throw fuzz::Finding(dialect.name + ": " + error.what() + "\n" + text);
  } catch (const fuzz::Finding& finding) {
    throw fuzz::Finding(dialect.name + ": " + finding.what() + "\n" + text);
  }
  return 0;
}
