// Bytes as a program in KRL, and as its data list.
#include "tests/fuzz/reader.h"
#include "tests/fuzz/robot_programs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string text(fuzz::text_of(data, size));
  fuzz::check_robot_reader(size, "a.src", [&](const toolpath::RobotOptions& options) {
    return toolpath::parse_krl(text, text, "a.src", options);
  });
  return 0;
}
