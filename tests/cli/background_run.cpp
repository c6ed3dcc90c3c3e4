#include "tests/cli/background_run.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "core/file/read_file.h"

namespace understudy::cli_test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{60};  // for a busy machine

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

}  // namespace

BackgroundRun::BackgroundRun(const Folder& folder, const std::string& words)
    : out_(folder / "out"), err_(folder / "err") {
  const std::string command = fmt::format("exec {} {} >{} 2>{}", UNDERSTUDY_PROGRAM, words, out_, err_);
  pid_ = ::fork();
  if (pid_ != 0) return;
  ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  ::_exit(127);
}

BackgroundRun::~BackgroundRun() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

std::string BackgroundRun::with_line_end(const std::string& file) {
  for (const auto end = Clock::now() + kPatience; Clock::now() < end; pause())
    if (std::filesystem::exists(file))
      if (const std::string text = read_file(file); text.find('\n') != std::string::npos) return text;
  return "";
}

void BackgroundRun::interrupt() const { ::kill(pid_, SIGINT); }

int BackgroundRun::wait() {
  int status = 0;
  for (const auto end = Clock::now() + 2 * kPatience; Clock::now() < end; pause())
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
  return -1;
}

}  // namespace understudy::cli_test
