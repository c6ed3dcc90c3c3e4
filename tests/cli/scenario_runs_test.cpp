#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// A short line on the bottle; three of them take seconds.
class ScenarioRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(understudy("plan surface bottle --tilt -2 2 -o " + (folder_ / "line.gcode")).status, 0);
    write("one", 1), write("two", 2);
  }

  void write(const std::string& name, int seed, const std::string& max = "0.5") {
    folder_.write(name + ".yaml",
                  "name: " + name +
                      "\ndescription: d\nsource: s\nmachine: hexapod\nprogram: line.gcode\nfixture: bottle\n"
                      "as_built: sampled\nseed: " +
                      std::to_string(seed) +
                      "\ngap_control: start\nengine: quasistatic\nexpect:\n"
                      "  - {metric: gap.start_mm, max: " +
                      max + ", unit: mm, source: a test}\n");
  }

  std::string at(const std::string& name) const { return folder_ / name; }
  std::string run(const std::string& words, int status = 0) {
    const Outcome outcome = understudy("scenario run " + words);
    EXPECT_EQ(outcome.status, status) << words << "\n" << outcome.out << outcome.err;
    return outcome.out + outcome.err;
  }

  const Folder folder_;
};

std::string without_times(std::string text) {
  for (auto at = text.find(" ("); at != std::string::npos; at = text.find(" (", at + 1))
    if (const auto end = text.find(" s)", at); end != std::string::npos) text.erase(at, end + 3 - at);
  return text;
}

TEST_F(ScenarioRuns, ProcessesAnswerAsOneAfterTheOther) {
  const std::string both = at("one.yaml") + " " + at("two.yaml");
  const std::string here = run(both + " --out " + at("a"));
  const std::string apart = run(both + " --processes 2 --out " + at("b"));
  EXPECT_EQ(without_times(here.substr(0, here.find("index:"))),
            without_times(apart.substr(0, apart.find("index:"))));
  for (const std::string name : {"one", "two"})
    EXPECT_EQ(read_file(at("a/" + name + "/trace.csv")), read_file(at("b/" + name + "/trace.csv")));
  EXPECT_THAT(run(both + " --processes 0", 2), HasSubstr("--processes 0 is outside 1..1024"));
}

TEST_F(ScenarioRuns, AProcessThatIsNotToldWhatToDoIsAFailedScenario) {
  std::string yaml = read_file(at("one.yaml"));
  yaml.replace(yaml.find("fixture: bottle"), 15, "fixture: botle");
  folder_.write("one.yaml", yaml);
  EXPECT_THAT(run(at("one.yaml") + " " + at("two.yaml") + " --processes 2", 2),
              HasSubstr("1 passed, 1 failed"));
}

TEST_F(ScenarioRuns, ResumeRunsOnlyWhatIsNotThereOrHasOtherInputs) {
  const std::string out = " --out " + at("out");
  run(at("one.yaml") + out);
  const std::string both = at("one.yaml") + " " + at("two.yaml") + out + " --resume";
  std::string told = run(both);
  EXPECT_THAT(told, HasSubstr("pass one (done before"));
  EXPECT_THAT(told, Not(HasSubstr("pass two (done before")));
  write("one", 3);
  told = run(both);
  EXPECT_THAT(told, Not(HasSubstr("pass one (done before"))) << "another seed";
  EXPECT_THAT(told, HasSubstr("pass two (done before"));
  write("one", 3, "0.0001");
  told = run(both, 1);
  EXPECT_THAT(told, HasSubstr("FAIL one (done before")) << "judged again, not run again";
  EXPECT_THAT(run(at("one.yaml") + " --resume", 2), HasSubstr("--resume needs --out"));
}

TEST_F(ScenarioRuns, ABaselineShowsWhatDiffers) {
  run(at("one.yaml") + " --out " + at("before"));
  EXPECT_THAT(run(at("one.yaml") + " --baseline " + at("before")), Not(HasSubstr("diff")));
  write("one", 9);
  EXPECT_THAT(run(at("one.yaml") + " --baseline " + at("before")), HasSubstr("diff gap.start_mm was "));
  EXPECT_THAT(run(at("two.yaml") + " --baseline " + at("before"), 2),
              HasSubstr("none of these scenarios has a result there"));
}

TEST_F(ScenarioRuns, GoldenFiguresAreWrittenHeldAndKept) {
  EXPECT_THAT(run(at("one.yaml") + " --update-golden"), HasSubstr("golden/one.yaml"));
  const std::string golden = read_file(at("golden/one.yaml"));
  EXPECT_THAT(golden, HasSubstr("metric: gap.start_mm, equals: 0."));
  EXPECT_THAT(golden, Not(HasSubstr("timing.")));
  EXPECT_THAT(run(at("one.yaml")), HasSubstr("ok   gap.start_mm = 0."));
  write("one", 9);
  EXPECT_THAT(run(at("one.yaml"), 1), HasSubstr("(golden/one.yaml:"));
  run(at("one.yaml") + " --update-golden", 1);  // this run still had the old ones
  EXPECT_NE(read_file(at("golden/one.yaml")), golden);
  run(at("one.yaml"));
  write("one", 9, "0.0001");
  const std::string kept = read_file(at("golden/one.yaml"));
  EXPECT_THAT(run(at("one.yaml") + " --update-golden", 1), HasSubstr("one fails: "));
  EXPECT_EQ(read_file(at("golden/one.yaml")), kept);
}

TEST_F(ScenarioRuns, AFailureTellsTheCommandThatRunsItAlone) {
  write("one", 1, "0.0001");
  const std::string told = run(at("one.yaml") + " --junit " + at("j.xml") + " --out " + at("out"), 1);
  EXPECT_THAT(told, HasSubstr("alone: understudy scenario run " + at("one.yaml")));
  EXPECT_THAT(read_file(at("j.xml")), HasSubstr(at("out/one/report.html")));
  EXPECT_THAT(read_file(at("out/index.html")), HasSubstr("one/report.html"));
  run(at("one.yaml") + " --out " + at("out"), 1);
  EXPECT_THAT(read_file(at("out/index.html")), HasSubstr("in 2 runs"));
}

TEST_F(ScenarioRuns, APageThatIsNotOursStays) {
  fs::create_directory(at("out"));
  folder_.write("out/index.html", "<html>mine</html>");
  EXPECT_THAT(run(at("one.yaml") + " --out " + at("out"), 2), HasSubstr("is no index of scenarios"));
  EXPECT_EQ(read_file(at("out/index.html")), "<html>mine</html>");
}

}  // namespace
}  // namespace understudy::cli_test
