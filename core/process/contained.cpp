#include "core/process/contained.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "core/error.h"
#include "core/error_context.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "core/process/memory.h"
#include "core/process/pipe.h"

namespace understudy {
namespace {

constexpr int kTick = 20;  // [ms] between looks at the clock and the user
constexpr std::size_t kChunk = 1 << 16;
// The clock goes on while others have the processor: so much longer, and [s] more.
constexpr double kWallTimes = 5, kWallMore = 5;
constexpr char kMade = 'm', kRefused = 'r';  // the first byte of an answer

using Resource = decltype(RLIMIT_CPU);

void limit(Resource resource, std::uint64_t value) {
  rlimit now{};
  ::getrlimit(resource, &now);
  now.rlim_cur = std::min<rlim_t>(now.rlim_max, value);
  ::setrlimit(resource, &now);
}

/// Of everything that is open, it needs its answer alone. A pipe of another one would stay open with it.
void close_others(int answer) {
  ::close_range(STDERR_FILENO + 1, static_cast<unsigned>(answer) - 1, 0);
  ::close_range(static_cast<unsigned>(answer) + 1, ~0U, 0);
}

void contain(const ContainedLimits& limits, int answer) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int each : {SIGXCPU, SIGPIPE, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) ::signal(each, SIG_DFL);
  ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  close_others(answer);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.seconds)));
  limit(RLIMIT_FSIZE, 0);
#ifndef UNDERSTUDY_SANITIZED  // which maps terabytes, and opens pipes to look whether memory can be read
  limit(RLIMIT_AS, mapped_memory() + limits.memory);
  limit(RLIMIT_NOFILE, 0);  // what is open stays so
#endif
}

std::string answer_of(const std::string& what, const std::function<std::string()>& work,
                      const ContainedLimits& limits) {
  try {
    return kMade + work();
  } catch (const InputError& error) {
    return kRefused + message_without_place(error);
  } catch (const std::bad_alloc&) {
    return kRefused + fmt::format("{} needs more than {:.1f} GB of memory", what,
                                  1e-9 * static_cast<double>(limits.memory));
  } catch (const std::exception& error) {
    return kRefused + fmt::format("{} failed: {}", what, error.what());
  }
}

/// Killed with the object, where it has not ended.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    static_cast<void>(status());
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// Waits for its end.
  int status() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return status;
  }

 private:
  pid_t pid_;
};

/// Until the child closes the pipe.
std::string read_all(const std::string& what, int file, const ContainedLimits& limits) {
  const auto began = std::chrono::steady_clock::now();
  const std::chrono::duration<double> patience(kWallTimes * limits.seconds + kWallMore);
  std::string bytes;
  std::array<char, kChunk> chunk{};
  while (true) {
    stop_if_interrupted();
    if (std::chrono::steady_clock::now() - began > patience)
      throw InputError(fmt::format("{} takes more than {:g} s", what, patience.count()));
    pollfd look{file, POLLIN, 0};
    if (::poll(&look, 1, kTick) <= 0) continue;
    const ssize_t count = ::read(file, chunk.data(), chunk.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return bytes;
    bytes.append(chunk.data(), static_cast<std::size_t>(count));
    if (bytes.size() > limits.result + 1)
      throw InputError(fmt::format("{} makes more than {} MB", what, limits.result / 1'000'000));
  }
}

std::string told_end(const std::string& what, int status, const ContainedLimits& limits) {
  if (!WIFSIGNALED(status)) return fmt::format("{} failed with status {}", what, WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGXCPU)
    return fmt::format("{} takes more than {:g} s of processor time", what, std::ceil(limits.seconds));
  return fmt::format("{} crashed with signal {} ({})", what, WTERMSIG(status), ::strsignal(WTERMSIG(status)));
}

}  // namespace

std::string run_contained(const std::string& what, const std::function<std::string()>& work,
                          const ContainedLimits& given) {
  ContainedLimits limits = given;
  if (const std::uint64_t free = available_memory(); free > 0) limits.memory = std::min(limits.memory, free);
  Pipe pipe;
  const pid_t pid = ::fork();
  if (pid < 0) throw MachineError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (pid == 0) {
    contain(limits, pipe.write.get());
    write_all(pipe.write.get(), answer_of(what, work, limits));
    ::_exit(0);
  }
  Child child(pid);
  pipe.write.close();
  std::string answer = read_all(what, pipe.read.get(), limits);
  if (const int status = child.status(); status != 0) throw InputError(told_end(what, status, limits));
  if (answer.empty()) throw InputError(what + " ended without an answer");
  const bool made = answer.front() == kMade;
  answer.erase(0, 1);
  if (!made) throw InputError(answer);
  return answer;
}

}  // namespace understudy
