#include "tests/fuzz/targets.h"

#include <algorithm>
#include <stdexcept>

// Each target's function has its reader's name in this program.
extern "C" {
#define FUZZ_TARGET(reader) int understudy_fuzz_##reader(const std::uint8_t* data, std::size_t size);
#include "fuzz_targets.inc"
#undef FUZZ_TARGET
}

namespace understudy::fuzz {

std::span<const Target> targets() {
  static constexpr Target kTargets[] = {
#define FUZZ_TARGET(reader) {#reader, understudy_fuzz_##reader},
#include "fuzz_targets.inc"
#undef FUZZ_TARGET
  };
  return kTargets;
}

void run(const std::string& reader, const std::string& input) {
  const auto found = std::find_if(targets().begin(), targets().end(),
                                  [&](const Target& target) { return reader == target.reader; });
  if (found == targets().end()) throw std::out_of_range("no fuzz target " + reader);
  found->one_input(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

}  // namespace understudy::fuzz
