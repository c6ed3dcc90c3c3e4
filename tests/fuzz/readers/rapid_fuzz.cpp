// Bytes as a program in RAPID.
#include <algorithm>

#include "tests/fuzz/reader.h"
#include "tests/fuzz/robot_programs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string text(fuzz::text_of(data, size));
  std::vector<toolpath::UnknownWordCount> unknown;
  toolpath::RobotFacts facts;
  for (const toolpath::RobotOptions& options : fuzz::robot_readings(unknown, facts)) {
    toolpath::Program program;
    // An arc becomes many chords, also before a line behind it is refused.
    const auto made = [&] { return std::max<std::size_t>(20'000, program.steps.size()); };
    if (fuzz::accepts(
            size, "a.mod", [&] { program = toolpath::parse_rapid(text, "a.mod", options); }, made))
      fuzz::check_robot_program(program, options);
  }
  return 0;
}
