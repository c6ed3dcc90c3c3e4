// Plug-ins that mean harm (hostile/): each ends within its limits with a reason in one line, and in the box
// none survives, writes outside, reaches the network or tells a secret. What remains without the box is in
// the table as well, and must be there: so each is seen to try.
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <sstream>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/plugin/box.h"
#include "calibration/plugin/plugin_estimator.h"
#include "core/file/descriptor.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kSecret = "4711-of-the-user";

/// What a plug-in brings about.
enum Effect : unsigned { nothing = 0, survives = 1, writes = 2, connects = 4, tells = 8, not_tried = 16 };

struct Hostile {
  const char* file;
  const char* reason;  ///< part of the message
  ProcessLimits limits;
  unsigned without_box = nothing;      ///< Effects that remain there
  const char* other_reason = nullptr;  ///< without the box
};

void PrintTo(const Hostile& plugin, std::ostream* out) { *out << plugin.file; }

// Those that hang get little time; those that fail by themselves much, for a machine that is busy.
const ProcessLimits kHangs{.time = 0.6}, kFails{.time = 20};
const char* const kLate = "did not end within 0.6 s";
const char* const kSilent = "wrote nothing to standard output";

const Hostile kAll[] = {
    {"fork_bomb.sh", "started more than 64 processes and threads", {.time = 20, .processes = 64}},
    {"session.sh", kSilent, kFails},
    {"unnamed_daemon.sh", kSilent, kFails, survives},
    {"ignores_signals.sh", kLate, kHangs},
    {"memory.py", "200 MB of memory", {.time = 20, .memory = 200'000'000}},
    {"memory_at_once.py", "ended with status 1 at its limit of 4 GB of memory", kFails},
    {"memory_of_many.py", "used more than 300 MB of memory", {.time = 20, .memory = 300'000'000}},
    {"cpu.sh", "used more than 0.2 s of CPU time", {.time = 20, .cores = 0.01}},
    {"flood.sh", "wrote more than 100000 bytes to standard output", {.time = 20, .output = 100'000}},
    {"flood_aside.sh", "wrote more than 5000 bytes to standard error", {.time = 20, .error_output = 5000}},
    {"deaf.sh", kLate, kHangs},
    {"silent.sh", kLate, kHangs},
    {"writes.sh", kSilent, kFails, writes},
    {"overwrites.sh", kSilent, kFails, writes},
    {"deletes.sh", kSilent, kFails, writes},
    {"connects.py", kSilent, kFails, connects},
    {"secret_variable.sh", "ended with status 1", kFails},
    {"secret_files.sh", "ended with status 1", kFails, tells},
    {"secret_of_process.sh", "ended with status 1", kFails, tells},
    {"deep.py", "nests lists or objects more than 100 deep", kFails},
    {"no_numbers.py", "not one JSON value", kFails},
    {"huge_numbers.py", "beyond 10000 mm", kFails},
    {"wrong_shapes.py", "base_joints_mm is not a list of 6", kFails},
    {"sparse_file.sh", "wrote a file of more than 1 MB", {.time = 20, .file = 1'000'000}, writes},
    {"many_files.sh",
     "at its limit of 8 MB of temporary files",
     {.time = 20, .own_folders = 8'000'000},
     writes,
     kSilent},
    {"kills.sh", "crashed with signal 9", kFails, not_tried},
    {"traces.py", "ended with status 1", kFails, not_tried},
    {"holds_pipes.sh", "not one JSON value: \"nonsense\"", kFails},
    {"late.sh", kLate, kHangs},
    {"open_files.py", "at its limit of 64 open files", {.time = 20, .open_files = 64}},
    {"descriptors.sh", kSilent, kFails},
    {"escape_codes.sh", "ended with status 1", kFails},
    {"no_such_file.sh", "ended with status", kFails},
};

/// Two listeners: on 127.0.0.1, and in /tmp.
class Listeners {
 public:
  explicit Listeners(const std::string& path)
      : path_(path),
        inet_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
        unix_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(inet_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::getsockname(inet_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    sockaddr_un file{};
    file.sun_family = AF_UNIX;
    path.copy(file.sun_path, sizeof file.sun_path - 1);
    EXPECT_EQ(::bind(unix_.get(), reinterpret_cast<sockaddr*>(&file), sizeof file), 0);
    EXPECT_EQ(::listen(inet_.get(), 5), 0);
    EXPECT_EQ(::listen(unix_.get(), 5), 0);
  }
  ~Listeners() { ::unlink(path_.c_str()); }
  int port() const { return port_; }
  bool were_called() const {
    pollfd watched[] = {{inet_.get(), POLLIN, 0}, {unix_.get(), POLLIN, 0}};
    return ::poll(watched, 2, 0) > 0;
  }

 private:
  std::string path_;
  Descriptor inet_, unix_;
  int port_ = 0;
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();  // which does not throw where a process is gone
  return text.str();
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// Every file below a folder, with what is in it.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[entry.path().string()] = entry.is_regular_file() ? content(entry.path()) : "";
  return files;
}

/// The processes with a mark in their words.
std::vector<pid_t> marked(const std::string& mark) {
  std::vector<pid_t> found;
  for (const auto& process : fs::directory_iterator("/proc")) {
    const std::string name = process.path().filename().string();
    pid_t pid = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (read.ec == std::errc() && pid != ::getpid() &&
        content(process.path() / "cmdline").find(mark) != std::string::npos)
      found.push_back(pid);
  }
  return found;
}

/// Killed processes take a moment to go; 2 s on a machine that is busy.
bool any_survives(const std::string& mark) {
  std::vector<pid_t> left = marked(mark);
  for (int tries = 0; tries < 100 && !left.empty(); ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    left = marked(mark);
  }
  for (const pid_t pid : left) ::kill(pid, SIGKILL);
  return !left.empty();
}

/// Files with the mark in folders that everyone may write to; they are removed.
bool any_outside(const std::string& mark, const std::string& ours) {
  bool any = false;
  for (const char* folder : {"/tmp", "/var/tmp", "/dev/shm"})
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string path = entry.path().string();
      if (path.find(mark) == std::string::npos || path == ours) continue;
      any = true;
      fs::remove_all(path);
    }
  return any;
}

Problem large_problem() {
  Problem problem{{machine::load_machine("hexapod").hexapod().geometry, {}}, {}};
  problem.samples.resize(400);  // more JSON than a pipe holds
  return problem;
}

class HostilePlugin : public ::testing::TestWithParam<Hostile> {
 protected:
  HostilePlugin() {
    write(root_ / "work/machine.yaml", "name: ours\n");
    write(root_ / "work/results/summary.json", "{}\n");
    write(root_ / "home/canary", "alive\n");
    write(root_ / "home/notes.txt", "mine\n");
    write(root_ / "home/.ssh/id", kSecret);
    write(root_ / "home/.netrc", kSecret);
    write(root_ / "work/open.txt", "");
    const Descriptor open(::open((root_ / "work/open.txt").c_str(), O_WRONLY | O_CLOEXEC));
    ::dup2(open.get(), 9);  // not closed on exec
    fs::current_path(root_ / "work");
    ::setenv("HOME", (root_ / "home").c_str(), 1);
    ::setenv("HOSTILE_SECRET", kSecret.c_str(), 1);
  }
  ~HostilePlugin() override {
    ::close(9);
    fs::current_path("/");
  }

  /// What came of it, after what holds for every plug-in anywhere.
  unsigned effects_of(const Hostile& plugin) {
    const std::string file = plugin.file;
    const std::string mark = fmt::format("hostile-{}-{}", ::getpid(), file.substr(0, file.find('.')));
    const std::string socket = "/tmp/" + mark + ".socket";
    const Listeners listeners(socket);
    const std::string command =
        fmt::format("{} " UNDERSTUDY_SOURCE_DIR "/tests/calibration/plugin/hostile/{} {} {} {}",
                    file.ends_with(".py") ? "python3" : "sh", file, mark, listeners.port(), ::getpid());
    const auto before = files_of(root_.path());
    const auto start = std::chrono::steady_clock::now();
    const Calibration found = make_plugin_estimator(command, plugin.limits)->calibrate(large_problem());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    message_ = found.message;
    fmt::print("{} in {:.1f} s: {}\n", file, seconds, message_);
    EXPECT_EQ(found.status, Status::no_answer);
    EXPECT_NE(message_, "");
    EXPECT_TRUE(std::ranges::all_of(message_, [](char c) { return c >= ' ' && c <= '~'; }));
    EXPECT_LT(message_.size(), 300u);
    EXPECT_LT(seconds, plugin.limits.time + 2);

    unsigned effects = nothing;
    if (any_survives(mark)) effects |= survives;
    if (any_outside(mark, socket) || files_of(root_.path()) != before) effects |= writes;
    if (listeners.were_called()) effects |= connects;
    if (message_.find(kSecret) != std::string::npos || message_.find("HOSTILE_SECRET") != std::string::npos)
      effects |= tells;
    return effects;
  }

  void expect_what_remains_without_the_box(const Hostile& plugin) {
    if (plugin.without_box == not_tried) {
      fmt::print("{}: not tried without the box, because it would end or stop the test\n", plugin.file);
      return;
    }
    EXPECT_EQ(effects_of(plugin), plugin.without_box);
    EXPECT_THAT(message_, HasSubstr(plugin.other_reason ? plugin.other_reason : plugin.reason));
  }

  TemporaryFolder root_;
  std::string message_;
};

TEST_P(HostilePlugin, IsContained) {
  if (!has_box()) {
    fmt::print(
        "bubblewrap is not installed or may make no namespaces here: what remains without it is checked\n");
    return expect_what_remains_without_the_box(GetParam());
  }
  EXPECT_EQ(effects_of(GetParam()), nothing);
  EXPECT_THAT(message_, HasSubstr(GetParam().reason));
}

TEST_P(HostilePlugin, FailsInItsTimeWithoutTheBox) {
  ::setenv("UNDERSTUDY_PLUGIN_BOX", "off", 1);
  expect_what_remains_without_the_box(GetParam());
  ::unsetenv("UNDERSTUDY_PLUGIN_BOX");
}

INSTANTIATE_TEST_SUITE_P(Extended, HostilePlugin, ::testing::ValuesIn(kAll), [](const auto& plugin) {
  const std::string file = plugin.param.file;
  return file.substr(0, file.find('.'));
});

}  // namespace
}  // namespace understudy::calibration
