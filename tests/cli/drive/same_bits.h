// Whether two setpoints are the same to the last bit.
#pragma once

#include <bit>
#include <cstdint>

#include "machine/port.h"

namespace understudy::cli_test {

/// 0 and -0 are two.
inline bool same_bits(const machine::Setpoint& a, const machine::Setpoint& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  bool all = same(a.time, b.time) && same(a.filament, b.filament) && a.line == b.line;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    all = all && same(a.position[i], b.position[i]) && same(a.velocity[i], b.velocity[i]);
  return all;
}

}  // namespace understudy::cli_test
