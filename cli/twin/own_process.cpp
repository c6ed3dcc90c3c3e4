#include "cli/twin/own_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/interrupt.h"

namespace understudy::cli {
namespace {

constexpr std::chrono::milliseconds kPoll{20};

/// `streams`: what the child gets as its standard streams.
pid_t start(const std::vector<std::string>& words, const posix_spawn_file_actions_t& streams) {
  std::vector<std::string> text{"understudy"};
  text.insert(text.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : text) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawn(&child, "/proc/self/exe", &streams, nullptr, arguments.data(), environ);
  if (error != 0) throw MachineError("cannot start a process: " + std::generic_category().message(error));
  return child;
}

class Streams {
 public:
  Streams() { posix_spawn_file_actions_init(&actions); }
  ~Streams() { posix_spawn_file_actions_destroy(&actions); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  posix_spawn_file_actions_t actions;
};

ProcessEnd end_of(int status) {
  if (WIFSIGNALED(status)) return {kFailed, fmt::format("the process ended by signal {}", WTERMSIG(status))};
  return {WEXITSTATUS(status), fmt::format("the process ended with status {}", WEXITSTATUS(status))};
}

}  // namespace

ProcessEnd run_own_process(const std::vector<std::string>& words) {
  stop_if_interrupted();
  Streams streams;
  posix_spawn_file_actions_addopen(&streams.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&streams.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const pid_t child = start(words, streams.actions);
  bool told = false;
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) throw MachineError("cannot wait for a process");
    if (interrupted() && !told) {
      kill(child, SIGTERM);
      told = true;
    }
    std::this_thread::sleep_for(kPoll);
  }
  stop_if_interrupted();
  return end_of(status);
}

pid_t start_own_process(const std::vector<std::string>& words, int input, int output) {
  Streams streams;
  posix_spawn_file_actions_adddup2(&streams.actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams.actions, output, STDOUT_FILENO);
  return start(words, streams.actions);
}

void end_with_parent() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() == 1) raise(SIGTERM);  // it ended before we asked
}

}  // namespace understudy::cli
