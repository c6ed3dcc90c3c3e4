#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/digest.h"
#include "core/file/read_file.h"
#include "core/random.h"
#include "tests/cli/line_in_air.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kTables[] = {"table.csv", "campaign.json", "campaign.html"};

/// The first column of the first row.
std::string asked(const fs::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  std::string answer;
  const auto take = [](void* to, int, char** columns, char**) {
    *static_cast<std::string*>(to) = columns[0] ? columns[0] : "";
    return 1;
  };
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database, sql.c_str(), take, &answer, nullptr);
  sqlite3_close(database);
  return answer;
}

class Campaign : public ::testing::Test {
 protected:
  void SetUp() override {
    write_line_in_air(folder_);
    write("c",
          "parameters:\n  - {key: machine.accuracy.tip_mm, values: [0.1, 0.5]}\nmetrics: "
          "[accuracy.tip_p95_um]\n");
  }
  void write(const std::string& name, const std::string& rest, const std::string& seeds = "1-10") {
    folder_.write(name + ".yaml", "name: " + name + "\nscenarios: [s.yaml]\nseeds: " + seeds + "\n" + rest);
  }
  std::string at(const std::string& name) const { return folder_ / name; }
  Outcome run(const std::string& words) const { return understudy("campaign " + words); }
  std::string tables(const std::string& folder) const {
    std::string all;
    for (const char* table : kTables) all += read_file(fs::path(at(folder)) / table);
    return all;
  }
  const Folder folder_;
};

TEST_F(Campaign, TheTablesDoNotDependOnTheNumberOfWorkers) {
  const Outcome one = run(at("c.yaml") + " --workers 1 --out " + at("one"));
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("c: 20 runs"));
  ASSERT_EQ(run(at("c.yaml") + " --workers 3 --out " + at("three")).status, 0);
  EXPECT_EQ(tables("one"), tables("three"));
  EXPECT_EQ(asked(at("one/runs.sqlite"), "SELECT count(*) FROM runs"), "20");
}

class ExtendedCampaign : public Campaign {};

TEST_F(ExtendedCampaign, ARowsCommandMakesItsSummaryAgain) {
  ASSERT_EQ(run(at("c.yaml") + " --workers 2 --out " + at("out")).status, 0);
  for (const int row : {0, 7, 13}) {
    const std::string where = " FROM runs WHERE run = " + std::to_string(row);
    std::string command = asked(at("out/runs.sqlite"), "SELECT command" + where);
    ASSERT_TRUE(command.starts_with("understudy ")) << command;
    command.resize(command.find(" --out "));
    const std::string out = at("again-" + std::to_string(row));
    const Outcome again = understudy(command.substr(11) + " --out " + out);
    EXPECT_LE(again.status, 1) << again.err;
    EXPECT_EQ(sha256_hex(read_file(out + "/summary.json")),
              asked(at("out/runs.sqlite"), "SELECT summary_sha256" + where))
        << row;
  }
}

TEST_F(ExtendedCampaign, GoesOnAfterADeathAndLosesNothing) {
  write("long", "parameters:\n  - {key: machine.accuracy.tip_mm, values: [0.1, 0.5]}\n", "1-40");
  ASSERT_EQ(run(at("long.yaml") + " --workers 2 --out " + at("whole")).status, 0);
  // Killed after 0.5, 1, ... s, until it comes to its end.
  int deaths = 0;
  for (double seconds = 0.5;; seconds += 0.5) {
    const Outcome part = understudy("campaign " + at("long.yaml") + " --workers 2 --out " + at("parts") +
                                    (deaths > 0 ? " --resume" : "") + " & p=$!; sleep " +
                                    std::to_string(seconds) + "; kill -9 $p 2>/dev/null; wait $p");
    if (part.status == 0) break;
    ++deaths;
    ASSERT_LT(deaths, 60);
  }
  EXPECT_EQ(tables("whole"), tables("parts"));
  EXPECT_EQ(asked(at("parts/runs.sqlite"), "SELECT count(*) FROM runs"), "80");
}

/// Children of `parent`, as /proc tells them.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::istringstream words(
      read_file("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children"));
  for (pid_t child = 0; words >> child;) children.push_back(child);
  return children;
}

/// A campaign in the background.
pid_t start(const std::string& campaign, const char* workers, const std::string& out) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::execl(UNDERSTUDY_PROGRAM, "understudy", "campaign", campaign.c_str(), "--workers", workers, "--out",
          out.c_str(), nullptr);
  ::_exit(127);
}

/// Ticks of processor time of each thread that a process has had.
using Ticks = std::map<pid_t, long>;

/// As far as /proc tells it now; threads that have ended keep what they had.
void add_ticks(pid_t process, Ticks& ticks) {
  std::error_code ended;
  for (const fs::directory_entry& thread :
       fs::directory_iterator("/proc/" + std::to_string(process) + "/task", ended)) {
    std::ifstream stat(thread.path() / "stat");
    std::string text;
    std::getline(stat, text);
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    const std::vector<std::string> words{std::istream_iterator<std::string>(fields), {}};
    if (words.size() < 13) continue;  // it has ended
    // utime and stime of proc(5)
    ticks[std::stoi(thread.path().filename())] = std::stol(words[11]) + std::stol(words[12]);
  }
}

// With gap control, so that it draws pictures and reads them. Threads that wait, for signals or for shaders
// to write to a cache, take no processor.
TEST_F(ExtendedCampaign, AWorkerComputesOnOneThread) {
  folder_.write("bottle.yaml", "name: bottle\nscenarios: ['" + kSource +
                                   "/scenarios/song-bottle.yaml']\nseeds: 1-4\nparameters:\n"
                                   "  - {key: scenario.engine, values: [quasistatic]}\n");
  const pid_t campaign = start(at("bottle.yaml"), "1", at("out"));
  std::map<pid_t, Ticks> workers;
  long computed = 0;
  int status = 0;
  while (::waitpid(campaign, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    for (const pid_t worker : children_of(campaign)) add_ticks(worker, workers[worker]);
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  for (auto& [worker, ticks] : workers) {
    long others = 0;
    for (const auto& [thread, used] : ticks) others += thread == worker ? 0 : used;
    EXPECT_LE(20 * others, ticks[worker]) << others;
    computed += ticks[worker];
  }
  EXPECT_GT(computed, 20) << "no worker was seen at work";
}

TEST_F(ExtendedCampaign, AWorkerThatIsKilledLosesNothing) {
  write("long", "parameters:\n  - {key: machine.accuracy.tip_mm, values: [0.1, 0.5]}\n", "1-100");
  ASSERT_EQ(run(at("long.yaml") + " --workers 2 --out " + at("whole")).status, 0);
  const pid_t campaign = start(at("long.yaml"), "2", at("killed"));
  Random random(1, "kills");
  int kills = 0, status = 0;
  while (::waitpid(campaign, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(random.uniform(50, 150))));
    if (kills == 20) continue;
    const std::vector<pid_t> workers = children_of(campaign);
    if (workers.empty()) continue;
    kills += ::kill(workers[random.bits() % workers.size()], SIGKILL) == 0 ? 1 : 0;
  }
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_GE(kills, 3);
  EXPECT_EQ(tables("whole"), tables("killed"));
}

TEST_F(Campaign, StopsWhenTheIntervalIsNarrowAndSaysSo) {
  write("stop", "stop: {half_width: 0.3, first: 4}\n", "1-64");
  const Outcome outcome = run(at("stop.yaml") + " --out " + at("out"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("runs of 64: every interval of P(GO) is within +-0.3"));
  EXPECT_LT(std::stoi(asked(at("out/runs.sqlite"), "SELECT count(*) FROM runs")), 64);
}

TEST_F(Campaign, AFolderThatHasRunsIsNotBegunAnew) {
  ASSERT_EQ(run(at("c.yaml") + " --out " + at("out")).status, 0);
  const std::string before = tables("out");
  const Outcome again = run(at("c.yaml") + " --out " + at("out"));
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("holds runs of this campaign: --resume goes on with them"));
  EXPECT_EQ(run(at("c.yaml") + " --resume --out " + at("out")).status, 0);
  EXPECT_EQ(tables("out"), before);
  write("c", "metrics: [accuracy.tip_max_um]\n");
  const Outcome changed = run(at("c.yaml") + " --resume --out " + at("out"));
  EXPECT_EQ(changed.status, 2);
  EXPECT_THAT(changed.err, HasSubstr("was changed since: begin in another folder"));
}

TEST_F(Campaign, AFolderThatAnotherCampaignWritesIsRefused) {
  ASSERT_EQ(run(at("c.yaml") + " --out " + at("out")).status, 0);
  const std::string lock = at("out/campaign.lock");
  std::FILE* held = std::fopen(lock.c_str(), "r");
  ASSERT_EQ(::flock(::fileno(held), LOCK_EX | LOCK_NB), 0);
  const Outcome busy = run(at("c.yaml") + " --resume --out " + at("out"));
  std::fclose(held);
  EXPECT_EQ(busy.status, 2);
  EXPECT_THAT(busy.err, HasSubstr("another campaign is writing here (process "));
}

TEST_F(Campaign, AUsersFolderIsLeftAlone) {
  fs::create_directories(at("thesis"));
  folder_.write("thesis/thesis.tex", "x");
  const Outcome outcome = run(at("c.yaml") + " --out " + at("thesis"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("holds thesis.tex, which no campaign wrote"));
  EXPECT_EQ(read_file(at("thesis/thesis.tex")), "x");
  EXPECT_FALSE(fs::exists(at("thesis/runs.sqlite")));
}

TEST_F(Campaign, AnUnknownKeyIsRefusedBeforeAnyRun) {
  const struct {
    const char *parameter, *message;
  } cases[] = {
      {"{key: machine.gap.aim_m, values: [1]}", "unknown key 'gap.aim_m', did you mean 'aim_mm'?"},
      {"{key: machin.gap.aim_mm, values: [1]}",
       "begins with none of machine, material, as_built, scenario, plan; did you mean 'machine'?"},
      {"{key: machine.gap.aim_mm, values: [0.13, 5]}", "gap.aim_mm is 5 mm"},
      {"{key: scenario.turn_dg, values: [1]}", "unknown key 'turn_dg', did you mean 'turn_deg'?"},
      {"{key: material.density_kg_per_m, values: [1]}",
       "unknown key 'density_kg_per_m', did you mean 'density_kg_per_m3'?"},
      {"{key: plan.layer, values: [1]}", "scenario 'line' has no plan: its program is a file"},
      {"{key: as_built.part.size, values: [1]}", "is as-built 'sampled', which is no file"},
  };
  for (const auto& one : cases) {
    write("bad", std::string("parameters:\n  - ") + one.parameter + "\n");
    const Outcome outcome = run(at("bad.yaml") + " --out " + at("out"));
    EXPECT_EQ(outcome.status, 2) << one.parameter;
    EXPECT_THAT(outcome.err, HasSubstr("bad.yaml:5:5: ")) << one.parameter;
    EXPECT_THAT(outcome.err, HasSubstr(one.message)) << one.parameter;
    EXPECT_FALSE(fs::exists(at("out"))) << one.parameter;
  }
}

TEST_F(Campaign, ARunThatCannotBeMadeHasNoAnswer) {
  // Each value goes with the others' first ones; the largest aim lies outside of the narrower band.
  write("band",
        "parameters:\n  - {key: machine.gap.accepted_max_mm, values: [0.2, 0.16]}\n"
        "  - {key: machine.gap.aim_mm, values: [0.13, 0.18]}\n",
        "1-2");
  const Outcome outcome = run(at("band.yaml") + " --out " + at("out"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      HasSubstr("machine.gap.accepted_max_mm 0.16, machine.gap.aim_mm 0.18: 2 runs, 2 without an answer"));
  EXPECT_EQ(asked(at("out/runs.sqlite"),
                  "SELECT count(*) FROM runs WHERE status = 'refused' AND error LIKE '%gap.aim_mm is 0.18 "
                  "mm, not between%'"),
            "2");
}

TEST_F(Campaign, VariesTheGainsOfTheController) {
  ASSERT_EQ(understudy("plan surface bottle --tilt -2 2 -o " + at("bottle.gcode")).status, 0);
  folder_.write(
      "b.yaml",
      "name: bottle\ndescription: d\nsource: s\nmachine: hexapod\nprogram: bottle.gcode\nfixture: bottle\n"
      "as_built: sampled\nseed: 1\ngap_control: start\nengine: quasistatic\nexpect:\n"
      "  - {metric: verdict, equals: go, source: a test}\n");
  folder_.write(
      "gains.yaml",
      "name: gains\nscenarios: [b.yaml]\nseeds: 1-2\nmetrics: [gap.frames, print.duration_s]\nparameters:\n"
      "  - {key: machine.gap_control.approach.step_fraction, values: [0.2, 0.9]}\n"
      "  - {key: machine.planner.lead_time_ms, values: [50, 1500]}\n");
  const Outcome outcome = run(at("gains.yaml") + " --out " + at("out"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto figure = [&](const std::string& what, const std::string& where) {
    return std::stod(asked(at("out/runs.sqlite"), "SELECT min(\"" + what + "\") FROM runs WHERE " + where));
  };
  // Steps of a fifth of what is left need more looks than steps of nine tenths.
  EXPECT_GT(figure("gap.frames", "\"machine.gap_control.approach.step_fraction\" = 0.2"),
            figure("gap.frames", "\"machine.gap_control.approach.step_fraction\" = 0.9"));
  // Each stretch of motion begins later by the difference: one at least.
  EXPECT_GT(figure("print.duration_s", "\"machine.planner.lead_time_ms\" = 1500"),
            figure("print.duration_s", "\"machine.planner.lead_time_ms\" = 50") + 1.4);
}

TEST_F(Campaign, WithoutSlurmSaysWhatIsMissing) {
  const char* path_now = std::getenv("PATH");
  ASSERT_NE(path_now, nullptr);
  const std::string path = path_now;
  ::setenv("PATH", at("empty").c_str(), 1);
  const Outcome none = run(at("c.yaml") + " --slurm --out " + at("out"));
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--slurm: there is no program sbatch"));
  EXPECT_FALSE(fs::exists(at("out/table.csv")));
}

}  // namespace
}  // namespace understudy::cli_test
