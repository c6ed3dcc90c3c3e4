#include "sim/twin/observer_thread.h"

#include <utility>

#include "core/error.h"
#include "core/thread_limit.h"

namespace understudy::sim {
namespace {

constexpr std::size_t kBatch = 256;
constexpr std::size_t kBatchesWaiting = 16;

}  // namespace

ObserverThread::ObserverThread(std::vector<Observer*> observers) : observers_(std::move(observers)) {
  filling_.reserve(kBatch);
  if (thread_limit() > 1) thread_ = std::thread([this] { work(); });
}

ObserverThread::~ObserverThread() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ObserverThread::observe(const Snapshot& snapshot) {
  filling_.push_back(snapshot);
  if (filling_.size() < kBatch) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kBatchesWaiting; });
  throw_failure();
  hand_over();
}

void ObserverThread::hand_over() {
  if (!thread_.joinable()) {
    if (failure_.empty()) failure_ = show(filling_);
    filling_.clear();
    return;
  }
  waiting_.push_back(std::move(filling_));
  filling_ = spare_.empty() ? Batch() : std::move(spare_.back());
  if (!spare_.empty()) spare_.pop_back();
  filling_.clear();
  filling_.reserve(kBatch);
  changed_.notify_all();
}

void ObserverThread::drain() {
  std::unique_lock lock(mutex_);
  if (!filling_.empty()) hand_over();
  changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
  throw_failure();
}

void ObserverThread::throw_failure() const {
  if (!failure_.empty()) throw MachineError("an observer of the run failed: " + failure_);
}

/// The failure of one of them, which ends it; empty when all have seen everything.
std::string ObserverThread::show(const Batch& batch) const {
  try {
    for (const Snapshot& snapshot : batch)
      for (Observer* observer : observers_) observer->observe(snapshot);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

// After a failure the rest is taken off unseen: every later call of the other side says why.
void ObserverThread::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return done_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Batch batch = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    const bool failed = !failure_.empty();
    lock.unlock();
    std::string failure = failed ? std::string() : show(batch);
    lock.lock();
    if (!failed) failure_ = std::move(failure);
    busy_ = false;
    spare_.push_back(std::move(batch));
    changed_.notify_all();
  }
}

}  // namespace understudy::sim
