// Independent jobs on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace understudy {

using IndexedWork = std::function<void(std::size_t index)>;
/// Called under a lock after each job; `finished` counts those that are done.
using JobDone = std::function<void(std::size_t index, std::size_t finished)>;

/// As many as the processor runs at once; 1 where that is not known.
int hardware_threads();

/// Runs work(0) .. work(count - 1), each once, on the calling thread and up to `threads` - 1 more, as far as
/// core/thread_limit.h allows. Jobs write where nobody else does. After a failure no further job begins; of
/// what was thrown that of the lowest index comes out. An interrupt (core/interrupt.h) counts as a failure.
void in_parallel(std::size_t count, int threads, const IndexedWork& work, const JobDone& done = {});

/// The same where each thread needs something of its own: it calls make_worker() once and runs what that
/// returns.
void in_parallel_with(std::size_t count, int threads, const std::function<IndexedWork()>& make_worker,
                      const JobDone& done = {});

}  // namespace understudy
