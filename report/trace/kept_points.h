// Which points of a curve a coarser one keeps.
#pragma once

#include <cstddef>
#include <vector>

namespace understudy::report {

/// The first, the last, and between them as few as a greedy walk finds: from one to the next with no more
/// than `most` steps, and such that `stands_for(a, b)` says that a and b stand for all between them. None of
/// none.
template <typename StandsFor>
std::vector<std::size_t> kept_points(std::size_t count, std::size_t most, const StandsFor& stands_for) {
  std::vector<std::size_t> kept;
  if (count > 0) kept.push_back(0);
  for (std::size_t at = 0; at + 1 < count;) {
    std::size_t next = at + 1;
    while (next + 1 < count && next - at < most && stands_for(at, next + 1)) ++next;
    kept.push_back(next);
    at = next;
  }
  return kept;
}

}  // namespace understudy::report
