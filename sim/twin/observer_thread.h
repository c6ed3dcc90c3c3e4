// Observers on a thread of their own, so that the machine is simulated on one core and watched on the other.
// In a process that may have one thread alone (core/thread_limit.h) they are called on that.
#pragma once

#include <vector>

#include "core/batch_thread.h"
#include "sim/observer.h"

namespace understudy::sim {

/// Hands every snapshot to each of the observers, in order. They cannot change the run, so the results are
/// those of calling them at once. When they fall far behind, observe() waits for them.
class ObserverThread : public Observer {
 public:
  /// The observers must outlive this and be called by nobody else before drain() has returned.
  explicit ObserverThread(std::vector<Observer*> observers);

  void observe(const Snapshot& snapshot) override { thread_.push(snapshot); }
  /// Waits until all snapshots so far have been seen. After an observer has thrown, this and observe() throw
  /// MachineError with its message; nothing is observed any more.
  void drain() { thread_.drain(); }

 private:
  BatchThread<Snapshot> thread_;
};

}  // namespace understudy::sim
