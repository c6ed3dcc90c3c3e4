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
#include "core/error.h"
#include "core/interrupt.h"

extern char** environ;

namespace understudy::calibration {
namespace {

constexpr int kTick = 20;  // [ms] between looks at the clock, the user and the child
constexpr std::size_t kChunk = 1 << 16;

/// Closes what it holds.
class Descriptor {
 public:
  Descriptor() = default;
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }
  bool open() const { return value_ >= 0; }
  int get() const { return value_; }
  void take(int value) {
    close();
    value_ = value;
  }

 private:
  int value_ = -1;
};

struct Pipe {
  Descriptor read, write;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw MachineError(fmt::format("no pipe for a plug-in: {}", std::strerror(errno)));
    read.take(ends[0]);
    write.take(ends[1]);
  }
};

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
  Child(const std::string& command, const Pipe& in, const Pipe& out, const Pipe& err) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&files, in.read.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, out.write.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.write.get(), STDERR_FILENO);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<std::string> words = boxed(command);
    std::vector<char*> arguments, environment{mark_.data()};
    for (std::string& word : words) arguments.push_back(word.data());
    for (char** entry = environ; *entry; ++entry) environment.push_back(*entry);
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

std::string ending(int status) {
  // A shell tells the death of its command as 128 and the signal.
  const bool by_shell =
      WIFEXITED(status) && WEXITSTATUS(status) > 128 && WEXITSTATUS(status) < 128 + SIGRTMIN;
  if (WIFSIGNALED(status) || by_shell) {
    const int signal = by_shell ? WEXITSTATUS(status) - 128 : WTERMSIG(status);
    return fmt::format("crashed with signal {} ({})", signal, ::strsignal(signal));
  }
  if (WEXITSTATUS(status) == 127) return "the command was not found (status 127)";
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

}  // namespace

std::string brief(const std::string& text, std::size_t length) {
  std::string line;
  for (const char c : text) {
    if (c == '\n' && line.find_first_not_of(" \t") != std::string::npos) break;
    line += c >= ' ' && c <= '~' ? c : ' ';
    if (line.size() > length) {
      line.resize(length);
      return line + "...";
    }
  }
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string::npos ? "" : line.substr(first);
}

ProcessRun run_process(const std::string& command, const std::string& input, const ProcessLimits& limits) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  Pipe in, out, err;
  NoBrokenPipeSignal quiet;
  Child child(command, in, out, err);
  in.read.close(), out.write.close(), err.write.close();
  unblock(in.write), unblock(out.read), unblock(err.read);

  ProcessRun run;
  std::size_t written = 0;
  while (in.write.open() || out.read.open() || err.read.open() || !child.ended()) {
    stop_if_interrupted();
    const bool ended = child.ended();  // before reading: all that it wrote is in the pipes
    pollfd watched[] = {
        {in.write.get(), POLLOUT, 0}, {out.read.get(), POLLIN, 0}, {err.read.get(), POLLIN, 0}};
    ::poll(watched, 3, ended ? 0 : kTick);
    if (in.write.open() && !feed(in.write, input, written)) in.write.close();
    if (out.read.open() && !drain(out.read, run.output, limits.output)) out.read.close();
    if (err.read.open() && !drain(err.read, run.error_output, limits.error_output)) err.read.close();
    if (run.output.size() > limits.output)
      run.failure = fmt::format("wrote more than {} bytes to standard output", limits.output);
    else if (run.error_output.size() > limits.error_output)
      run.failure = fmt::format("wrote more than {} bytes to standard error", limits.error_output);
    else if (elapsed() > limits.time)
      run.failure = fmt::format("did not end within {:g} s", limits.time);
    if (!run.failure.empty() || ended) break;  // a process it left behind may hold the pipes open
  }
  const int status = child.end();
  run.seconds = elapsed();
  if (run.failure.empty() && status != 0) run.failure = ending(status);
  if (!run.failure.empty() && !brief(run.error_output).empty())
    run.failure += fmt::format("; standard error: \"{}\"", brief(run.error_output));
  run.ok = run.failure.empty();
  return run;
}

}  // namespace understudy::calibration
