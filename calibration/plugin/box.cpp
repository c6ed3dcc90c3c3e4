#include "calibration/plugin/box.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr const char* kSetpriv = "/usr/bin/setpriv";
constexpr const char* kBubblewrap = "/usr/bin/bwrap";
// /dev/shm of its own is the one place that it may write to.
constexpr const char* kBox =
    "--ro-bind / / --dev /dev --proc /proc --unshare-net --unshare-pid --unshare-ipc --die-with-parent "
    "--new-session --setenv TMPDIR /dev/shm";
constexpr int kRounds = 20;  // what a process starts while we look is found in the next

bool works(const std::string& command) {
  const int status = std::system((command + " >/dev/null 2>&1 </dev/null").c_str());
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool find_box() {
  const char* wanted = std::getenv("UNDERSTUDY_PLUGIN_BOX");
  if (wanted && std::string(wanted) == "off") return false;
  return ::access(kBubblewrap, X_OK) == 0 && works(fmt::format("{} {} /bin/true", kBubblewrap, kBox));
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

/// Of a zombie, or of a process that is not ours to look at: empty.
std::string environment_of(const fs::path& process) {
  std::ifstream file(process / "environ", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

bool has_box() {
  static const bool found = find_box();
  return found;
}

std::vector<std::string> boxed(const std::string& command) {
  std::vector<std::string> words;
  if (::access(kSetpriv, X_OK) == 0) words = {kSetpriv, "--pdeathsig", "KILL"};
  if (has_box()) {
    words.push_back(kBubblewrap);
    for (const std::string& word : words_of(kBox)) words.push_back(word);
  }
  words.insert(words.end(), {"/bin/sh", "-c", command});
  return words;
}

std::string next_run_mark() {
  static std::atomic<int> runs{0};
  return fmt::format("UNDERSTUDY_PLUGIN_RUN={}-{}", ::getpid(), ++runs);
}

void kill_marked(const std::string& mark) {
  const std::string entry = mark + '\0';
  for (int round = 0; round < kRounds; ++round) {
    bool any = false;
    std::error_code ignored;
    for (const auto& process : fs::directory_iterator("/proc", ignored)) {
      const std::string name = process.path().filename().string();
      pid_t pid = 0;
      const auto read = std::from_chars(name.data(), name.data() + name.size(), pid);
      if (read.ec != std::errc() || read.ptr != name.data() + name.size() || pid == ::getpid()) continue;
      const std::string environment = environment_of(process.path());
      if (!environment.starts_with(entry) && environment.find('\0' + entry) == std::string::npos) continue;
      any = ::kill(pid, SIGKILL) == 0 || any;
    }
    if (!any) return;
  }
}

}  // namespace understudy::calibration
