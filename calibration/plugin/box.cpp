#include "calibration/plugin/box.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/plugin/box_words.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr const char* kSetpriv = "/usr/bin/setpriv";
constexpr int kRounds = 20;  // what a process starts while we look is found in the next

bool works(const std::string& command) {
  const int status = std::system((command + " >/dev/null 2>&1 </dev/null").c_str());
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool find_box() {
  return ::access(kBubblewrap, X_OK) == 0 &&
         works(fmt::format("{} /bin/true", fmt::join(namespace_words({}), " ")));
}

bool is_unwanted() {
  const char* wanted = std::getenv("UNDERSTUDY_PLUGIN_BOX");
  return wanted && std::string(wanted) == "off";
}

/// Of a zombie, or of a process that is not ours to look at: empty.
std::string environment_of(const fs::path& process) {
  std::ifstream file(process / "environ", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

bool has_box() {
  if (is_unwanted()) return false;
  static const bool found = find_box();
  return found;
}

std::string box_warning() {
  if (is_unwanted() || has_box()) return {};
  return fmt::format(
      "warning: plug-ins run without a box, and may reach what you may reach: {}; "
      "UNDERSTUDY_PLUGIN_BOX=off accepts that (docs/calibration-plugins.md)",
      ::access(kBubblewrap, X_OK) == 0 ? "bubblewrap may make no namespaces here" : "install bubblewrap");
}

std::vector<std::string> boxed(const std::string& command, const ProcessLimits& limits) {
  std::vector<std::string> words;
  const auto append = [&](const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  const bool box = has_box();
  if (::access(kSetpriv, X_OK) == 0) {
    append({kSetpriv, "--pdeathsig", "KILL"});
    if (!box) append({"--no-new-privs"});  // bubblewrap does it by itself
  }
  if (box) append(namespace_words(limits)), append(sight_words(command));
  append(limit_words(limits));
  append({"/bin/sh", "-c", command});
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
