// The follower's loop on the hexapod, begun where the gap is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "machine/description.h"
#include "tests/control/gap/follower_loop.h"

namespace understudy::control {

constexpr double kAim = 0.13e-3;  // [m]

inline GapFollowerOptions options_of_hexapod() {
  return gap_follower_options(machine::load_machine("hexapod"));
}

/// The filter alone: its tool is not moved to see whether readings follow it.
inline GapFollowerOptions filter_alone() {
  GapFollowerOptions options = options_of_hexapod();
  options.excitation = 0;
  return options;
}

/// A loop that knows the gap where it begins.
inline FollowerLoop loop_with(const FollowerLoop::Error& error, double noise = 0, std::uint64_t seed = 1,
                              GapFollowerOptions options = filter_alone()) {
  FollowerLoop loop(options, error, noise, seed);
  loop.follower.start(0, 0, error(0, 0), std::max(noise, 0.1e-6));
  return loop;
}

inline double rms_from(const FollowerLoop& loop, double from, double around) {
  double squares = 0;
  int n = 0;
  for (const auto& p : loop.points)
    if (p.time >= from) {
      squares += std::pow(p.gap - around, 2);
      ++n;
    }
  return std::sqrt(squares / n);
}

}  // namespace understudy::control
