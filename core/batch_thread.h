// One stage of a pipeline: items are worked off in their order on a thread of its own.
// In a process that may have one thread alone (core/thread_limit.h) they are worked off on the caller's.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/thread_limit.h"

namespace understudy {

/// Items are handed over in batches, and push() waits while `batches_waiting` of them wait: memory is
/// bounded. All but the work is for one thread.
template <typename Item>
class BatchThread {
 public:
  /// `work` takes the items of a batch, which it may change.
  using Work = std::function<void(std::vector<Item>& batch)>;

  BatchThread(Work work, std::size_t batch_size, std::size_t batches_waiting = 16)
      : work_(std::move(work)), batch_size_(batch_size), waiting_most_(batches_waiting) {
    filling_.reserve(batch_size_);
    if (thread_limit() > 1) thread_ = std::thread([this] { run(); });
  }
  ~BatchThread() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  BatchThread(const BatchThread&) = delete;
  BatchThread& operator=(const BatchThread&) = delete;

  /// After the work has thrown, this and drain() throw the same each time; nothing is worked off any more.
  void push(Item item) {
    filling_.push_back(std::move(item));
    if (filling_.size() < batch_size_) return;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < waiting_most_; });
    rethrow();
    hand_over();
  }

  /// Waits until all items so far have been worked off.
  void drain() {
    std::unique_lock lock(mutex_);
    if (!filling_.empty()) hand_over();
    changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
    rethrow();
  }

 private:
  using Batch = std::vector<Item>;

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  void hand_over() {
    if (!thread_.joinable()) {
      if (!failure_) failure_ = failure_of(filling_);
      filling_.clear();
      return;
    }
    waiting_.push_back(std::move(filling_));
    filling_ = spare_.empty() ? Batch() : std::move(spare_.back());
    if (!spare_.empty()) spare_.pop_back();
    filling_.clear();
    filling_.reserve(batch_size_);
    changed_.notify_all();
  }

  std::exception_ptr failure_of(Batch& batch) const {
    try {
      work_(batch);
    } catch (...) {
      return std::current_exception();
    }
    return nullptr;
  }

  // After a failure the rest is taken off without work: every later call of the other side says why.
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return done_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      Batch batch = std::move(waiting_.front());
      waiting_.pop_front();
      busy_ = true;
      const bool failed = failure_ != nullptr;
      lock.unlock();
      std::exception_ptr failure = failed ? nullptr : failure_of(batch);
      lock.lock();
      if (!failed) failure_ = std::move(failure);
      busy_ = false;
      spare_.push_back(std::move(batch));
      changed_.notify_all();
    }
  }

  Work work_;
  std::size_t batch_size_, waiting_most_;
  Batch filling_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> waiting_;
  std::vector<Batch> spare_;
  bool busy_ = false, done_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace understudy
