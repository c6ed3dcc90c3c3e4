// Observers on a thread of their own, so that the machine is simulated on one core and watched on the other.
// In a process that may have one thread alone (core/thread_limit.h) they are called on that.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sim/observer.h"

namespace understudy::sim {

/// Hands every snapshot to each of the observers, in order. They cannot change the run, so the results are
/// those of calling them at once. When they fall far behind, observe() waits for them.
class ObserverThread : public Observer {
 public:
  /// The observers must outlive this and be called by nobody else before drain() has returned.
  explicit ObserverThread(std::vector<Observer*> observers);
  ~ObserverThread() override;

  void observe(const Snapshot& snapshot) override;
  /// Waits until all snapshots so far have been seen. After an observer has thrown, this and observe() throw
  /// MachineError with its message; nothing is observed any more.
  void drain();

 private:
  using Batch = std::vector<Snapshot>;
  std::string show(const Batch& batch) const;
  void hand_over();
  void work();
  void throw_failure() const;

  std::vector<Observer*> observers_;
  Batch filling_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> waiting_;
  std::vector<Batch> spare_;
  bool busy_ = false, done_ = false;
  std::string failure_;
  std::thread thread_;
};

}  // namespace understudy::sim
