#include "cli/twin/own_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/file/descriptor.h"
#include "core/interrupt.h"
#include "core/process/error_output.h"
#include "core/process/pipe.h"

namespace understudy::cli {
namespace {

constexpr int kPoll = 20;  // [ms]

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

void pass_on(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// What has come; waits kPoll for the first of it.
void read_errors(const Descriptor& errors, ErrorOutput& said) {
  pollfd look{errors.get(), POLLIN, 0};
  char bytes[4096];
  for (int wait = kPoll; ::poll(&look, 1, wait) > 0; wait = 0) {
    const ssize_t count = ::read(errors.get(), bytes, sizeof bytes);
    if (count <= 0) {
      if (wait > 0) ::poll(nullptr, 0, kPoll);  // closed, and the process has not ended
      return;
    }
    pass_on(said.take({bytes, static_cast<std::size_t>(count)}));
  }
}

/// Its status, as waitpid() tells it.
int watched_to_its_end(pid_t child, const Descriptor& errors, ErrorOutput& said) {
  int status = 0;
  for (bool told = false;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) throw MachineError("cannot wait for a process");
    read_errors(errors, said);
    if (ended == child) return status;
    if (interrupted() && !told) {
      kill(child, SIGTERM);
      told = true;
    }
  }
}

ProcessEnd end_of(int status) {
  if (WIFSIGNALED(status)) return {kFailed, fmt::format("the process ended by signal {}", WTERMSIG(status))};
  return {WEXITSTATUS(status), fmt::format("the process ended with status {}", WEXITSTATUS(status))};
}

}  // namespace

ProcessEnd run_own_process(const std::vector<std::string>& words) {
  stop_if_interrupted();
  Pipe errors;
  Streams streams;
  posix_spawn_file_actions_addopen(&streams.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&streams.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&streams.actions, errors.write.get(), STDERR_FILENO);
  const pid_t child = start(words, streams.actions);
  errors.write.close();
  ErrorOutput said;
  const int status = watched_to_its_end(child, errors.read, said);
  stop_if_interrupted();
  ProcessEnd end = end_of(status);
  const std::string reason = said.reason();
  if (end.status > kNo && !reason.empty())
    end.text = reason;
  else
    pass_on(said.rest());
  return end;
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
