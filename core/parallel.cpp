#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/interrupt.h"
#include "core/thread_limit.h"

namespace understudy {
namespace {

/// The failure of the lowest index, from any thread.
class FirstFailure {
 public:
  void keep(std::size_t index, std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (failure_ && index >= index_) return;
    index_ = index;
    failure_ = std::move(failure);
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::size_t index_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

int hardware_threads() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

void in_parallel_with(std::size_t count, int threads, const std::function<IndexedWork()>& make_worker,
                      const JobDone& done) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> give_up{false};
  FirstFailure failure;
  std::mutex done_mutex;
  std::size_t finished = 0;
  const auto run = [&] {
    std::size_t index = count;  // of a worker that cannot be made: after all others
    try {
      const IndexedWork work = make_worker();
      while (!give_up && (index = next++) < count) {
        stop_if_interrupted();
        work(index);
        const std::lock_guard lock(done_mutex);
        ++finished;
        if (done) done(index, finished);
      }
    } catch (...) {
      failure.keep(index, std::current_exception());
      give_up = true;
    }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t wanted =
        std::min(count, static_cast<std::size_t>(std::clamp(threads, 1, thread_limit())));
    for (std::size_t i = 1; i < wanted; ++i) others.emplace_back(run);
    run();
  }
  failure.rethrow();
}

void in_parallel(std::size_t count, int threads, const IndexedWork& work, const JobDone& done) {
  in_parallel_with(
      count, threads, [&] { return work; }, done);
}

}  // namespace understudy
