#include "drivers/hal/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <thread>

#include "core/error.h"

namespace understudy::drivers {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

struct Pipe {
  Descriptor read, write;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw MachineError("no pipe could be made to a program of LinuxCNC");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Between fork and exec: nothing that allocates. `streams[i]` becomes descriptor i; -1 leaves it closed.
[[noreturn]] void become(char* const* words, const char* folder, const std::array<int, 4>& streams,
                         bool dies_with_us) {
  ::setpgid(0, 0);
  if (dies_with_us) ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  prefer_this_thread();
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  if (*folder != '\0' && ::chdir(folder) != 0) ::_exit(127);
  // Out of the way first: one of them may have the number of another.
  std::array<int, 4> moved{};
  for (std::size_t i = 0; i < streams.size(); ++i)
    moved[i] = streams[i] < 0 ? -1 : ::fcntl(streams[i], F_DUPFD, 10);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (moved[i] < 0) continue;
    ::dup2(moved[i], static_cast<int>(i));
    ::close(moved[i]);
  }
  ::execvp(words[0], words);
  ::_exit(127);
}

}  // namespace

void prefer_this_thread() { static_cast<void>(::setpriority(PRIO_PROCESS, 0, -10)); }

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::string& folder,
                           const ChildStreams& streams, bool dies_with_us) {
  const Descriptor nowhere(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Pipe in, out;
  if (streams.input) in = make_pipe();
  if (streams.output) out = make_pipe();
  const int log = streams.log >= 0 ? streams.log : nowhere.get();
  const std::array<int, 4> theirs{streams.input ? in.read.get() : nowhere.get(),
                                  streams.output ? out.write.get() : log, log, streams.inherited};
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw MachineError("no process could be made for " + words.front());
  if (pid_ == 0) become(arguments.data(), folder.c_str(), theirs, dies_with_us);
  ::setpgid(pid_, pid_);
  input = std::move(in.write);
  output = std::move(out.read);
  for (const Descriptor* end : {&input, &output})
    if (end->is_open()) ::fcntl(end->get(), F_SETFL, O_NONBLOCK);
}

bool ChildProcess::running() {
  if (pid_ < 0) return false;
  if (::waitpid(pid_, &status_, WNOHANG) == 0) return true;
  pid_ = -1;
  return false;
}

bool ChildProcess::ended_within(milliseconds time) {
  const auto until = Clock::now() + time;
  while (running()) {
    if (Clock::now() >= until) return false;
    std::this_thread::sleep_for(milliseconds(2));
  }
  return true;
}

bool ChildProcess::end(milliseconds patience) {
  input.close();
  if (pid_ < 0 || ended_within(patience)) return true;
  const pid_t group = -pid_;
  ::kill(group, SIGTERM);
  if (ended_within(milliseconds(1000))) return false;
  ::kill(group, SIGKILL);
  static_cast<void>(ended_within(milliseconds(1000)));
  return false;
}

std::string answer_of(const std::vector<std::string>& words, milliseconds time) {
  ChildStreams streams;
  streams.output = true;
  ChildProcess child(words, "", streams, true);
  const auto until = Clock::now() + time;
  std::string text;
  std::array<char, 4096> part{};
  while (Clock::now() < until) {
    pollfd ready{child.output.get(), POLLIN, 0};
    if (::poll(&ready, 1, 10) <= 0) continue;
    const ssize_t got = ::read(child.output.get(), part.data(), part.size());
    if (got > 0) text.append(part.data(), static_cast<std::size_t>(got));
    if (got != 0) continue;
    child.end(milliseconds(500));
    return child.status() == 0 ? text : std::string();
  }
  return {};
}

}  // namespace understudy::drivers
