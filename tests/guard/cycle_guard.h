// Counts what a control cycle must not do: allocations, locks, input and output. A test program that links
// cycle_guard.cpp has its functions in front of the C library's, for its own code and for every shared
// library that it uses: MuJoCo, Bullet and the C++ library's own streams and operator new.
#pragma once

#include <ostream>

namespace understudy {

struct Calls {
  long allocations =
      0;           ///< malloc, calloc, realloc, aligned_alloc, posix_memalign; what is freed is not counted
  long locks = 0;  ///< mutexes and reader-writer locks, taken or tried
  long io = 0;     ///< files opened, read, written
  bool operator==(const Calls&) const = default;
};
inline Calls operator-(const Calls& a, const Calls& b) {
  return {a.allocations - b.allocations, a.locks - b.locks, a.io - b.io};
}
inline std::ostream& operator<<(std::ostream& out, const Calls& calls) {
  return out << calls.allocations << " allocations, " << calls.locks << " locks, " << calls.io
             << " calls of input or output";
}

/// By this thread since it began.
Calls calls();

/// By this thread since it began.
long allocations();

/// False under a sanitizer, whose own library stands in front of the C library: allocations are counted
/// there, locks, input and output are not.
bool counts_locks_and_io();

/// What `cycle` has called.
template <typename Cycle>
Calls calls_of(Cycle&& cycle) {
  const Calls before = calls();
  cycle();
  return calls() - before;
}

}  // namespace understudy
