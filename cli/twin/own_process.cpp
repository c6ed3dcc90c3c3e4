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

pid_t start(const std::vector<std::string>& words) {
  std::vector<std::string> text{"understudy"};
  text.insert(text.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : text) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw MachineError("cannot start a process: " + std::generic_category().message(error));
  return child;
}

ProcessEnd end_of(int status) {
  if (WIFSIGNALED(status)) return {kFailed, fmt::format("the process ended by signal {}", WTERMSIG(status))};
  return {WEXITSTATUS(status), fmt::format("the process ended with status {}", WEXITSTATUS(status))};
}

}  // namespace

ProcessEnd run_own_process(const std::vector<std::string>& words) {
  stop_if_interrupted();
  const pid_t child = start(words);
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

void end_with_parent() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() == 1) raise(SIGTERM);  // it ended before we asked
}

}  // namespace understudy::cli
