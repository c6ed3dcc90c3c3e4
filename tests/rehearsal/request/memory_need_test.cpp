#include "rehearsal/request/memory_need.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/process/memory.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

class MemoryNeed : public testing::Test {
 protected:
  RehearsalRequest lines(int count, const std::string& name) const {
    std::string text = "G21 G90 M83\nM104 S200\nG0 X-20 Y0 Z1\nG1 Z0.15 F600\n";
    for (int i = 0; i < count; ++i)
      text += fmt::format("G1 X{:.3f} Y{:.1f} E0.003 F1200\n", 0.1 * (i % 200) - 20, 0.4 * (i / 200 % 100));
    write_file(folder / name, text);
    RehearsalRequest request;
    request.program = (folder / name).string();
    request.machine = "arm";
    request.engine = "quasistatic";
    request.gap_control = "off";
    request.keep_scene = false;
    return request;
  }
  TemporaryFolder folder;
};

/// [bytes], the most that a process of its own took; below 0: it failed.
double peak_of(const RehearsalRequest& request) {
  int ends[2];
  if (::pipe(ends) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    (void)rehearse(request);
    std::ifstream status("/proc/self/status");
    double kilobytes = -1;
    for (std::string word; status >> word;)
      if (word == "VmHWM:") status >> kilobytes;
    const double peak = 1024 * kilobytes;
    [[maybe_unused]] const ssize_t ignored = ::write(ends[1], &peak, sizeof(peak));
    ::_exit(0);
  }
  ::close(ends[1]);
  double peak = -1;
  [[maybe_unused]] const ssize_t ignored = ::read(ends[0], &peak, sizeof(peak));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return peak;
}

/// An estimate that is four times too high would refuse what a computer can do.
void expect_covered(const RehearsalRequest& request) {
#ifdef UNDERSTUDY_SANITIZED
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#endif
  const double peak = peak_of(request), need = memory_need(request, 1);
  ASSERT_GT(peak, 0);
  EXPECT_LT(peak, need);
  EXPECT_GT(4 * peak, need);
}

TEST_F(MemoryNeed, IsNotBelowThePeakNorFarAboveIt) { expect_covered(lines(5000, "some.gcode")); }

using SlowMemoryNeed = MemoryNeed;
TEST_F(SlowMemoryNeed, OfALongProgramIsNotBelowThePeakNorFarAboveIt) {
  expect_covered(lines(200'000, "many.gcode"));
}

TEST_F(MemoryNeed, OfALargeMicroscopeIsNotBelowThePeakNorFarAboveIt) {
  RehearsalRequest request = lines(10, "some.gcode");
  const double bare = memory_need(request, 1);
  request.machine = "hexapod{microscope.width_px: 1600, microscope.height_px: 1200}";
  EXPECT_EQ(memory_need(request, 1), bare) << "without gap control it takes no picture";
  request.gap_control = "start";
  expect_covered(request);
}

TEST_F(MemoryNeed, GrowsWithTheFixtureAndTheRuns) {
  RehearsalRequest request = lines(10, "a.gcode");
  const double bare = memory_need(request, 1);
  write_file(folder / "part.stl", std::string(84 + 50 * 100'000, '\0'));
  request.fixture = (folder / "part.stl").string();
  EXPECT_NEAR(memory_need(request, 1) - bare, 100e6, 1e6) << "1 kB a triangle: 0.86 kB were measured";
  EXPECT_GT(memory_need(request, 2), memory_need(request, 1));
  EXPECT_EQ(runs_at_most(request), 1);
  request.gap_control = "start";
  request.before = "arm";
  EXPECT_EQ(runs_at_most(request), 3);
}

TEST_F(MemoryNeed, WhatDoesNotFitIsRefusedBeforeItIsRead) {
  const RehearsalRequest many = lines(100'000, "many.gcode");
  EXPECT_NO_THROW(check_memory(many));
  const pid_t child = ::fork();
  if (child == 0) {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    const rlimit limit{used + 200'000'000, used + 200'000'000};
    ::setrlimit(RLIMIT_AS, &limit);
    try {
      (void)rehearse(many);
    } catch (const InputError& error) {
      ::_exit(std::string(error.what()).find("needs about 0.3 GB of memory, and 0.2 GB are free") !=
                      std::string::npos
                  ? 0
                  : 1);
    }
    ::_exit(2);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(MemoryNeed, PipesAndMissingFilesCountNothing) {
  RehearsalRequest request = lines(10, "a.gcode");
  const double some = memory_need(request, 1);
  request.program = (folder / "none.gcode").string();
  EXPECT_LT(memory_need(request, 1), some);
}

}  // namespace
}  // namespace understudy::rehearsal
