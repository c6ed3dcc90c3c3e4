#include "calibration/plugin/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "calibration/plugin/box.h"
#include "calibration/plugin/plugin_environment.h"
#include "core/error.h"
#include "core/file/descriptor.h"
#include "core/interrupt.h"
#include "core/process/pipe.h"

namespace understudy::calibration {
namespace {

constexpr int kTick = 20;  // [ms] between looks at the clock, the user and the child
constexpr std::size_t kChunk = 1 << 16;

void unblock(const Descriptor& end) { ::fcntl(end.get(), F_SETFL, O_NONBLOCK); }

/// A write into a pipe whose reader is gone must come back as an error, not as a signal. The signal goes to
/// the writing thread, so blocking it here and taking it away leaves the process as it was.
class NoBrokenPipeSignal {
 public:
  NoBrokenPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoBrokenPipeSignal() {
    const timespec now{0, 0};
    while (::sigtimedwait(&pipe_, nullptr, &now) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_, before_;
};

/// In a box (box.h). posix_spawn, not Boost.Process: 1.74 resets no signal mask and has no timed wait for two
/// pipes without Asio.
class Child {
 public:
  Child(const std::string& command, const ProcessLimits& limits, const Pipe& in, const Pipe& out,
        const Pipe& err) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&files, in.read.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, out.write.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.write.get(), STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    // A session of its own has no terminal, into which a program could type.
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<std::string> words = boxed(command, limits), variables = plugin_environment();
    variables.push_back(mark_);
    std::vector<char*> arguments, environment;
    for (std::string& word : words) arguments.push_back(word.data());
    for (std::string& variable : variables) environment.push_back(variable.data());
    arguments.push_back(nullptr), environment.push_back(nullptr);
    const int failed =
        posix_spawn(&pid_, arguments[0], &files, &attributes, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) throw MachineError(fmt::format("no plug-in can be started: {}", std::strerror(failed)));
  }
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Whether it has ended by itself; it stays a zombie, so that its number is nobody else's, until end().
  bool ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == pid_;
  }

  ProcessUsage usage() const { return usage_of(pid_); }

  /// Kills what is left of all that it started and takes the status of its first process.
  int end() {
    if (reaped_) return status_;
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
    kill_marked(mark_);
    while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
    }
    reaped_ = true;
    return status_;
  }

 private:
  std::string mark_ = next_run_mark();
  pid_t pid_ = -1;
  int status_ = 0;
  bool reaped_ = false;
};

/// Appends what there is, up to `limit` and one byte more. False at the end of the stream.
bool drain(Descriptor& end, std::string& text, std::size_t limit) {
  std::array<char, kChunk> buffer;
  while (text.size() <= limit) {
    const ssize_t n = ::read(end.get(), buffer.data(), std::min(buffer.size(), limit + 1 - text.size()));
    if (n > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(n));
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
      return false;
    } else if (errno == EAGAIN) {
      return true;
    }
  }
  return true;
}

/// Writes what the pipe takes. False when all is written or nobody reads.
bool feed(Descriptor& end, const std::string& text, std::size_t& written) {
  while (written < text.size()) {
    const ssize_t n = ::write(end.get(), text.data() + written, std::min(kChunk, text.size() - written));
    if (n > 0) {
      written += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      return true;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return false;
}

/// Which limit the program has exceeded until now; empty where none.
class Watch {
 public:
  Watch(const Child& child, const ProcessLimits& limits) : child_(child), limits_(limits) {}
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  std::string exceeded(const ProcessRun& run) {
    if (run.output.size() > limits_.output)
      return fmt::format("wrote more than {} bytes to standard output", limits_.output);
    if (run.error_output.size() > limits_.error_output)
      return fmt::format("wrote more than {} bytes to standard error", limits_.error_output);
    if (seconds() > limits_.time) return fmt::format("did not end within {:g} s", limits_.time);
    if (Clock::now() < next_look_) return {};
    const std::string used = calibration::exceeded(child_.usage(), limits_);
    next_look_ = Clock::now() + std::chrono::milliseconds(kTick);
    return used;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Child& child_;
  const ProcessLimits& limits_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point next_look_ = start_;
};

}  // namespace

ProcessRun run_process(const std::string& command, const std::string& input, const ProcessLimits& limits,
                       const Progress& progress) {
  Pipe in, out, err;
  NoBrokenPipeSignal quiet;
  Child child(command, limits, in, out, err);
  Watch watch(child, limits);
  in.read.close(), out.write.close(), err.write.close();
  unblock(in.write), unblock(out.read), unblock(err.read);

  ProcessRun run;
  std::size_t written = 0;
  while (in.write.is_open() || out.read.is_open() || err.read.is_open() || !child.ended()) {
    stop_if_interrupted();
    if (progress)
      progress(watch.seconds() / limits.time, fmt::format("the plug-in, {:g} s at most", limits.time));
    const bool ended = child.ended();  // before reading: all that it wrote is in the pipes
    pollfd watched[] = {
        {in.write.get(), POLLOUT, 0}, {out.read.get(), POLLIN, 0}, {err.read.get(), POLLIN, 0}};
    ::poll(watched, 3, ended ? 0 : kTick);
    if (in.write.is_open() && !feed(in.write, input, written)) in.write.close();
    if (out.read.is_open() && !drain(out.read, run.output, limits.output)) out.read.close();
    if (err.read.is_open() && !drain(err.read, run.error_output, limits.error_output)) err.read.close();
    run.failure = watch.exceeded(run);
    if (!run.failure.empty() || ended) break;  // a process it left behind may hold the pipes open
  }
  const int status = child.end();
  run.seconds = watch.seconds();
  if (run.failure.empty() && status != 0) run.failure = told_ending(status, run.error_output, limits);
  const std::string words = last_words(run.error_output);
  if (!run.failure.empty() && !words.empty()) run.failure += fmt::format("; standard error: \"{}\"", words);
  run.ok = run.failure.empty();
  return run;
}

}  // namespace understudy::calibration
