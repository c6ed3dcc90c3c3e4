// What a plug-in may do to us: nothing but fail, within its time, with a reason.
#include "calibration/plugin/plugin.h"

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/plugin/exchange.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "machine/description.h"

namespace understudy::rehearsal {
namespace {

using ::testing::HasSubstr;

class Script {
 public:
  explicit Script(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("understudy-plugin-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".sh");
    std::ofstream(path_) << text;
  }
  ~Script() { std::filesystem::remove(path_); }
  std::string command() const { return "sh " + path_.string(); }

 private:
  std::filesystem::path path_;
};

PluginRun run(const std::string& text, const std::string& input = "in\n", const PluginLimits& limits = {}) {
  return run_plugin(Script(text).command(), input, limits);
}

/// Kill 0 finds a process or a zombie.
bool alive(pid_t pid) { return ::kill(pid, 0) == 0; }

/// The number that a script wrote; the process must be gone soon after its group was killed.
void expect_gone(const std::string& number) {
  const pid_t pid = std::stoi(number);
  for (int tries = 0; tries < 200 && alive(pid); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(alive(pid)) << pid;
}

TEST(Plugin, AnswersWhatItReads) {
  const PluginRun good = run("cat; echo aside >&2", "one line\n");
  EXPECT_TRUE(good.ok) << good.failure;
  EXPECT_EQ(good.output, "one line\n");
  EXPECT_EQ(good.error_output, "aside\n");
}

// A pipe holds 64 KiB: both ends must be served at once or both wait for ever.
TEST(Plugin, MayWriteWhileItReads) {
  const std::string much(900'000, 'x');
  const PluginRun echo = run("cat", much);
  EXPECT_TRUE(echo.ok) << echo.failure;
  EXPECT_EQ(echo.output, much);
}

TEST(Plugin, MayLeaveItsInputUnread) {
  const PluginRun deaf = run("exec <&-; echo answer; sleep 0.1", std::string(900'000, 'x'));
  EXPECT_TRUE(deaf.ok) << deaf.failure;
  EXPECT_EQ(deaf.output, "answer\n");
}

TEST(Plugin, ThatHangsIsKilledWithAllItStarted) {
  const auto start = std::chrono::steady_clock::now();
  const PluginRun hung = run("sleep 100 & echo $!\nsleep 100", "", {.time = 0.3});
  EXPECT_FALSE(hung.ok);
  EXPECT_THAT(hung.failure, HasSubstr("did not end within 0.3 s"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  expect_gone(hung.output);
}

TEST(Plugin, ThatIgnoresSignalsAndClosesItsStreamsStillEnds) {
  const PluginRun hung =
      run("trap '' TERM INT HUP\nexec >&- 2>&-\nwhile :; do sleep 1; done", "", {.time = 0.3});
  EXPECT_THAT(hung.failure, HasSubstr("did not end within"));
}

TEST(Plugin, ThatFloodsIsStoppedAtTheLimit) {
  const PluginRun flood = run("yes", "", {.output = 100'000});
  EXPECT_THAT(flood.failure, HasSubstr("more than 100000 bytes to standard output"));
  EXPECT_LE(flood.output.size(), 100'001u);
  const PluginRun aside = run("yes >&2", "", {.error_output = 5000});
  EXPECT_THAT(aside.failure, HasSubstr("more than 5000 bytes to standard error"));
  EXPECT_LT(aside.failure.size(), 250u) << "quotes a little of it only";
}

TEST(Plugin, ThatCrashesIsToldWithItsLastWords) {
  EXPECT_THAT(run("echo 'no such matrix' >&2; exit 3").failure,
              ::testing::AllOf(HasSubstr("status 3"), HasSubstr("\"no such matrix\"")));
  EXPECT_THAT(run("kill -SEGV $$").failure, HasSubstr("signal 11"));
  EXPECT_THAT(run_plugin("/nowhere/at-all", "").failure, HasSubstr("not found"));
}

// What it leaves behind holds the pipes open: that must not keep us.
TEST(Plugin, LeavesNoProcessBehind) {
  const PluginRun left = run("sleep 100 & echo $!", "");
  EXPECT_TRUE(left.ok) << left.failure;
  EXPECT_LT(left.seconds, 5);
  expect_gone(left.output);
}

TEST(Plugin, BrokenPipesAreNoSignalToUs) {
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(run("exit 0", std::string(500'000, 'x')).ok);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_FALSE(sigismember(&pending, SIGPIPE));
}

calibration::Problem problem() {
  const auto machine = machine::load_machine("hexapod");
  const auto mechanism = machine.make_mechanism();
  calibration::Problem p{{machine.hexapod().geometry, {}}, {}};
  Random random(1, "plugin test");
  calibration::HexapodParameters truth = p.nominal;
  truth.geometry = calibration::perturbed(p.nominal.geometry, 0.5e-3, random);
  for (const Pose& X : calibration::random_reachable_poses(
           *mechanism, calibration::reference_region(machine.X_BT_home), 12, random)) {
    calibration::PoseSample sample;
    if (true_sample(truth, p.nominal.geometry, X, calibration::kReferenceNoise, {}, sample))
      p.samples.push_back(sample);
  }
  return p;
}

PluginAnswer ask(const std::string& script) {
  double seconds = 0;
  return ask_plugin(Script(script).command(), problem(), {.time = 5}, seconds);
}

TEST(CalibrationPlugin, NonsenseIsAFailureThatSaysWhatIsWrong) {
  const std::string answer = R"("schema": "understudy.calibration-answer/1")";
  EXPECT_THAT(ask("echo hello").failure, HasSubstr("not one JSON value: \"hello\""));
  EXPECT_THAT(ask("echo '{}' >&2").failure,
              ::testing::AllOf(HasSubstr("nothing to standard output"), HasSubstr("{}")));
  EXPECT_THAT(ask("echo '{}'").failure, HasSubstr("schema is null"));
  EXPECT_THAT(ask("echo '[]'").failure, HasSubstr("not an object"));
  EXPECT_THAT(ask("echo '{\"schema\": \"understudy.calibration-answer/2\"}'").failure, HasSubstr("answer/2"));
  EXPECT_THAT(ask("echo '{" + answer + "}'").failure, HasSubstr("has no base_joints_mm"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": [[1,2,3]]}'").failure, HasSubstr("list of 6"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"failure\": \"too few\"}'").failure, HasSubstr("says: too few"));
  EXPECT_THAT(ask("cat").failure, HasSubstr("schema is \"understudy.calibration-problem/1\""));
  const std::string rows = "[[1,2,3],[1,2,3],[1,2,3],[1,2,3],[1,2,3],[1,2,";
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "1e300]]}'").failure,
              HasSubstr("beyond"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "NaN]]}'").failure,
              HasSubstr("not one JSON"));
  EXPECT_THAT(ask("echo '{" + answer + ", \"base_joints_mm\": " + rows + "null]]}'").failure,
              HasSubstr("not a number"));
}

// The example solves exact data exactly; 1e-6 m: its steps end at 1e-9 mm, times a condition near 1000.
TEST(CalibrationPlugin, TheExampleFindsTheMachineWithoutNoise) {
  double seconds = 0;
  const calibration::Problem exact = problem();
  const PluginAnswer found = ask_plugin(
      "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/strut_by_strut.py", exact, {}, seconds);
  ASSERT_TRUE(found.ok) << found.failure;
  for (const auto& sample : exact.samples) {
    const auto reached = kinematics::forward(
        found.parameters.geometry, calibration::strut_lengths(found.parameters, sample), sample.X_BT);
    EXPECT_LT((reached.X_BT.translation() - sample.X_BT.translation()).norm(), 1e-9);
  }
  Random random(1, "plugin test");
  const auto truth = calibration::perturbed(exact.nominal.geometry, 0.5e-3, random);
  for (std::size_t i = 0; i < calibration::kStruts; ++i)
    EXPECT_LT((truth.base_joint[i] - found.parameters.geometry.base_joint[i]).norm(), 1e-6);
  calibration::Problem few = exact;
  few.samples.resize(5);
  const PluginAnswer refused = ask_plugin(
      "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/strut_by_strut.py", few, {}, seconds);
  EXPECT_THAT(refused.failure, HasSubstr("fewer than 7 poses"));
}

}  // namespace
}  // namespace understudy::rehearsal
