#include "sim/twin/observer_thread.h"

#include <string>
#include <utility>

#include "core/error.h"

namespace understudy::sim {
namespace {

constexpr std::size_t kBatch = 256;

void show(const std::vector<Observer*>& observers, const std::vector<Snapshot>& batch) {
  try {
    for (const Snapshot& snapshot : batch)
      for (Observer* observer : observers) observer->observe(snapshot);
  } catch (const std::exception& error) {
    throw MachineError("an observer of the run failed: " + std::string(error.what()));
  }
}

}  // namespace

ObserverThread::ObserverThread(std::vector<Observer*> observers)
    : thread_([all = std::move(observers)](std::vector<Snapshot>& batch) { show(all, batch); }, kBatch) {}

}  // namespace understudy::sim
