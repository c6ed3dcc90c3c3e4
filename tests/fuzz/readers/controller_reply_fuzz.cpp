// Bytes as what a controller says on the line.
#include "tests/fuzz/controller_talk.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  fuzz::talk(fuzz::text_of(data, size));
  return 0;
}
