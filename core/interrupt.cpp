#include "core/interrupt.h"

#include <atomic>
#include <csignal>

#include "core/error.h"

namespace understudy {
namespace {

std::atomic<bool> flag{false};

// A second signal ends the process at once, for a user who will not wait.
void on_signal(int number) {
  if (flag.exchange(true)) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return flag.load(); }
void set_interrupted(bool value) { flag.store(value); }

void stop_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace understudy
