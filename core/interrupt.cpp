#include "core/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "core/counted_interrupts.h"
#include "core/error.h"
#include "core/partial_results.h"

namespace understudy {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
constexpr std::chrono::milliseconds kPatience{800};

std::atomic<bool> flag{false};
std::atomic<int> received{0};
std::atomic<bool> counting{false};
std::atomic<int> counted{0};
constexpr int kCountedMax = 3;  // whoever asks once more will not wait for a machine
sem_t first_signal;             // a semaphore may be posted in a handler

void die_of(int number) {
  std::signal(number, SIG_DFL);
  sigset_t that;
  sigemptyset(&that);
  sigaddset(&that, number);
  ::pthread_sigmask(SIG_UNBLOCK, &that, nullptr);
  ::kill(::getpid(), number);
  while (true) ::pause();
}

// A second signal ends the process at once, for a user who will not wait.
void on_signal(int number) {
  received.store(number);
  if (counting.load() && counted.fetch_add(1) < kCountedMax) {
    flag.store(true);
    return;
  }
  if (flag.exchange(true)) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  ::sem_post(&first_signal);
}

/// Its own thread: it looks at the clock while the others work.
void end_what_does_not_answer() {
  while (::sem_wait(&first_signal) != 0) {
  }
  std::this_thread::sleep_for(kPatience);
  remove_partial_results();
  std::string said(kInterrupted);
  said += '\n';
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, said.data(), said.size());
  die_of(received.load());
}

}  // namespace

void watch_for_interrupt() {
  ::sem_init(&first_signal, 0, 0);
  for (const int number : kSignals)  // one that is ignored (nohup, a shell's background) stays so
    if (std::signal(number, on_signal) == SIG_IGN) std::signal(number, SIG_IGN);
  // The signals are for the working threads: this one only waits.
  sigset_t mine, before;
  sigemptyset(&mine);
  for (const int number : kSignals) sigaddset(&mine, number);
  ::pthread_sigmask(SIG_BLOCK, &mine, &before);
  std::thread(end_what_does_not_answer).detach();
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

CountedInterrupts::CountedInterrupts() {
  counted.store(0);
  counting.store(true);
}

CountedInterrupts::~CountedInterrupts() { counting.store(false); }

int CountedInterrupts::count() { return counted.load(); }

bool interrupted() { return flag.load(); }
void set_interrupted(bool value) { flag.store(value); }

void stop_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

void die_of_interrupt() {
  if (received.load() != 0) die_of(received.load());
}

}  // namespace understudy
