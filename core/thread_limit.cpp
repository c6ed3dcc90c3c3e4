#include "core/thread_limit.h"

#include <atomic>
#include <limits>

#include "core/assert.h"

namespace understudy {
namespace {

std::atomic<int> limit{std::numeric_limits<int>::max()};

}  // namespace

void limit_threads(int most) {
  UNDERSTUDY_ASSERT(most >= 1, "a process computes on one thread at least");
  limit = most;
}

int thread_limit() { return limit; }

}  // namespace understudy
