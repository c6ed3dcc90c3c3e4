#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/descriptor.h"
#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTick{2};
constexpr milliseconds kStart{60'000};  // for a command to begin its work on a busy machine
constexpr milliseconds kSettle{300};    // where nothing tells that it has begun
constexpr milliseconds kPromise{1000};  // to end after a signal (docs/limits.md)
constexpr milliseconds kBusy{1500};     // by which a busy machine may be late
constexpr milliseconds kAtOnce{500};    // well below what a single signal may take
constexpr milliseconds kBetween{50};    // two signals

bool waited_for(const std::function<bool()>& done, milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (!done()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(kTick);
  }
  return true;
}

/// Some process has both words in its command line, the first at its beginning.
bool runs(const std::string& program, const std::string& word) {
  std::error_code error;
  for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
    std::ifstream file(entry->path() / "cmdline", std::ios::binary);
    std::string line;
    std::getline(file, line, '\xff');  // all of it, or nothing of a process that ends meanwhile
    if (line.starts_with(program) && line.find(word) != std::string::npos) return true;
  }
  return false;
}

/// The command as a process, its three streams given.
class Running {
 public:
  Running(const std::string& words, int in, int out, int err) : process_(::fork()) {
    if (process_ != 0) return;
    // What runs the tests may ignore them, and a child inherits that.
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    std::istringstream split(words);
    std::vector<std::string> list{UNDERSTUDY_PROGRAM};
    for (std::string word; split >> word;) list.push_back(word);
    std::vector<char*> pointers;
    for (std::string& word : list) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  ~Running() {
    if (ended()) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int number) const { ::kill(process_, number); }
  bool ended() {
    if (!ended_) ended_ = ::waitpid(process_, &status_, WNOHANG) == process_;
    return ended_;
  }
  /// The signal that it died of, as a shell tells by 128 and more; 0: of none.
  int died_of() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }

 private:
  pid_t process_;
  int status_ = 0;
  bool ended_ = false;
};

/// "@" in the words is the test's folder. It is at work as soon as `begun` exists or, where that is a pipe,
/// is read or, where that is a plug-in, runs.
struct Work {
  const char* name;
  std::string words, begun;
};

void PrintTo(const Work& work, std::ostream* out) { *out << work.words; }

class InterruptTest : public ::testing::Test {
 protected:
  InterruptTest() {
    folder_.write("plugin.sh", "#!/bin/sh\nsleep 600\n");
    fs::permissions(folder_ / "plugin.sh", fs::perms::owner_all);
    for (const char* name : {"pipe", "pipe.yaml"}) ::mkfifo((folder_ / name).c_str(), 0600);
    if (::pipe2(silent_, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  }
  ~InterruptTest() override {
    for (const int end : silent_) ::close(end);
  }
  std::string here(std::string words) const {
    for (auto at = words.find('@'); at != std::string::npos; at = words.find('@'))
      words.replace(at, 1, folder_.path().string());
    return words;
  }
  bool at_work(const std::string& begun, Running& run) {
    if (begun.empty()) {
      std::this_thread::sleep_for(kSettle);
      return true;
    }
    return waited_for(
        [&] {
          if (begun.ends_with(".sh")) return runs("/bin/sh", begun) || run.ended();
          if (!fs::is_fifo(begun)) return fs::exists(begun) || run.ended();
          if (pipe_.get() < 0) pipe_ = Descriptor(::open(begun.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
          return pipe_.get() >= 0 || run.ended();
        },
        kStart);
  }
  /// Whatever lies there when all is over, but what the test put there.
  std::vector<std::string> left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name != "pipe" && name != "pipe.yaml" && !name.starts_with("plugin.") && name != "err" &&
          name != "out.journal")
        names.push_back(name);
    }
    return names;
  }

  Folder folder_;
  int silent_[2];
  Descriptor pipe_;
};

class Interrupted : public InterruptTest, public ::testing::WithParamInterface<Work> {};

TEST_P(Interrupted, EndsWithinASecondAndLeavesNothing) {
  const Work& work = GetParam();
  for (const int number : {SIGTERM, SIGINT}) {
    const Descriptor err(::open((folder_ / "err").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    Running run(here(work.words), silent_[0], err.get(), err.get());
    ASSERT_TRUE(at_work(here(work.begun), run));
    ASSERT_FALSE(run.ended()) << read_file(folder_ / "err");
    run.send(number);
    EXPECT_TRUE(waited_for([&] { return run.ended(); }, kPromise + kBusy)) << work.words;
    EXPECT_EQ(run.died_of(), number) << read_file(folder_ / "err");
    EXPECT_THAT(left(), ::testing::IsEmpty());
    EXPECT_TRUE(waited_for([&] { return !runs("", here("@/plugin.sh")); }, kBusy));
    pipe_ = Descriptor();
  }
}

const Work kWork[] = {
    {"AxesOnAPipe", "axes", ""},
    {"PosesOnAPipe", "poses --machine arm", ""},
    {"AMachineThatIsAPipe", "axes --machine @/pipe.yaml", "@/pipe.yaml"},
    {"AProgramThatIsAPipe", "rehearse @/pipe --out @/out", "@/pipe"},
    {"AScenarioThatIsAPipe", "scenario run @/pipe.yaml --out @/out --junit @/junit.xml", "@/pipe.yaml"},
    {"MeasurementsThatAreAPipe", "calibrate @/pipe -o @/m.yaml --report @/out", "@/pipe"},
    {"WaypointsThatAreAPipe", "plan waypoints @/pipe -o @/p.gcode", "@/pipe"},
    {"APluginOfACalibration",
     "calibrate " + kSource +
         "/scenarios/calibration/hexapod-24-poses.csv --plugin @/plugin.sh -o @/m.yaml --report @/out",
     "@/plugin.sh"},
    {"APluginOfABenchmark",
     "benchmark calibration --plugin @/plugin.sh --estimators robust --trials 4 -j 2 --out @/out",
     "@/plugin.sh"},
    {"ABenchmarkOnThreads", "benchmark calibration --trials 10000 -j 2 --out @/out", "@/out.part"},
    {"ASweepOnThreads", "sweep " + kSource + "/scenarios/song-bottle.yaml --samples 50 -j 2 --out @/out",
     "@/out.part"},
    {"AWorkspace", "workspace --all-azimuths --step 1 -j 2 --out @/out", "@/out.part"},
    {"APrint",
     "rehearse " + kSource +
         "/scenarios/song-bottle.gcode --fixture bottle --gap-control continuous --out @/out",
     "@/out.part"},
    {"PicturesOfDots", "sample-gaps -o @/out", "@/out.part"},
    {"PicturesOfBoards",
     "sample-poses --from pixels --as-built manufactured --count 40 --pictures @/out -o @/m.csv",
     "@/out.part"},
};

INSTANTIATE_TEST_SUITE_P(Commands, Interrupted, ::testing::ValuesIn(kWork),
                         [](const auto& work) { return work.param.name; });

/// Its whole answer does not fit into a pipe.
class BlockedByItsReader : public InterruptTest {
 protected:
  BlockedByItsReader()
      : rows_(::open(folder_.write("rows.csv", many_rows()).c_str(), O_RDONLY | O_CLOEXEC)),
        run_("axes", rows_.get(), silent_[1], nowhere_.get()) {}
  static std::string many_rows() {
    std::string rows = "x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
    for (int i = 0; i < 5000; ++i) rows += "0,0,60,1,0,0,0\n";
    return rows;
  }
  bool waits() {
    return waited_for(
        [&] {
          int bytes = 0;
          return ::ioctl(silent_[0], FIONREAD, &bytes) == 0 && bytes >= ::fcntl(silent_[0], F_GETPIPE_SZ);
        },
        kStart);
  }
  Descriptor nowhere_{::open("/dev/null", O_WRONLY | O_CLOEXEC)}, rows_;
  Running run_;
};

TEST_F(BlockedByItsReader, EndsWithinASecond) {
  ASSERT_TRUE(waits());
  run_.send(SIGTERM);
  EXPECT_TRUE(waited_for([&] { return run_.ended(); }, kPromise + kBusy));
  EXPECT_EQ(run_.died_of(), SIGTERM);
}

TEST_F(BlockedByItsReader, ASecondSignalEndsItAtOnce) {
  ASSERT_TRUE(waits());
  run_.send(SIGTERM);
  std::this_thread::sleep_for(kBetween);
  run_.send(SIGINT);
  EXPECT_TRUE(waited_for([&] { return run_.ended(); }, kAtOnce));
  EXPECT_EQ(run_.died_of(), SIGINT);
}

}  // namespace
}  // namespace understudy::cli_test
