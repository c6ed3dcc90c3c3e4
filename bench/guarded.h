// How a benchmark ends that threw.
#pragma once

#include <cstdio>
#include <exception>

namespace understudy::bench {

/// The status that `run` gives, or 3 with one line on standard error where it throws.
template <typename Run>
int guarded(const char* name, Run run) noexcept {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 3;
  }
}

}  // namespace understudy::bench
