#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kPlain = " --no-pictures --out ";

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

/// What was printed of a scenario, down to the next one.
std::string told_of(const std::string& name, const std::string& text) {
  const auto begin = text.find(name + "\n");
  if (begin == std::string::npos) return "nothing";
  const auto end = text.find("time ", begin);
  return text.substr(begin, text.find('\n', end) - begin);
}

TEST_F(ScenarioRuns, WhenQuietOnlyFailuresAreTold) {
  write("two", 2, "0.01");  // no gap is so small
  const Outcome told = understudy("scenario run --quiet " + at("one.yaml") + " " + at("two.yaml"));
  EXPECT_EQ(told.status, 1);
  EXPECT_THAT(told.out, ::testing::StartsWith("FAIL two\n"));
  EXPECT_THAT(told.out, ::testing::EndsWith("1 passed, 1 failed\n"));
  EXPECT_THAT(told.out, Not(HasSubstr("one.yaml")));
}

TEST_F(ScenarioRuns, OneJsonDocumentHoldsAllResults) {
  run(at("one.yaml") + kPlain + at("before"));
  write("one", 2, "0.01");
  const Outcome told = understudy("scenario run --json " + at("one.yaml") + " --baseline " + at("before") +
                                  kPlain + at("out"));
  EXPECT_EQ(told.status, 1);
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json["schema"], "understudy.scenarios/1");
  EXPECT_EQ(json["passed"], 0);
  EXPECT_EQ(json["failed"], 1);
  const auto& one = json["scenarios"][0];
  EXPECT_EQ(one["name"], "one");
  EXPECT_EQ(one["passed"], false);
  EXPECT_GT(one["checks"][0]["value"], 0.01);
  EXPECT_THAT(one["checks"][0]["message"].get<std::string>(), HasSubstr("above 0.01 mm"));
  EXPECT_FALSE(one["changes"].empty()) << "another seed is another machine";
  EXPECT_TRUE(fs::exists(one["report"].get<std::string>()));
}

TEST_F(ScenarioRuns, ProcessesAnswerAsOneAfterTheOther) {
  const std::string both = at("one.yaml") + " " + at("two.yaml");
  const std::string here = run(both + kPlain + at("a"));
  const std::string apart = run(both + " --processes 2" + kPlain + at("b"));
  for (const std::string name : {"one", "two"}) {
    const auto checks = [&](const std::string& text) {
      return told_of(name, text).substr(0, text.find("time"));
    };
    EXPECT_THAT(checks(here), HasSubstr("ok   gap.start_mm <= 0.5 mm"));
    EXPECT_THAT(checks(apart), HasSubstr("ok   gap.start_mm <= 0.5 mm"));
    EXPECT_EQ(read_file(at("a/" + name + "/trace.csv")), read_file(at("b/" + name + "/trace.csv")));
  }
  EXPECT_THAT(run(both + " --processes 0", 2), HasSubstr("--processes 0 is outside 1..1024"));
}

TEST_F(ScenarioRuns, OneThatCannotRunFailsBesideThoseThatCan) {
  std::string yaml = read_file(at("one.yaml"));
  yaml.replace(yaml.find("fixture: bottle"), 15, "fixture: botle");
  folder_.write("one.yaml", yaml);
  EXPECT_THAT(run(at("one.yaml") + " " + at("two.yaml") + " --processes 2", 2),
              AllOf(HasSubstr("1 passed, 1 failed"), HasSubstr("one.yaml: no fixture botle: ")));
}

TEST_F(ScenarioRuns, ResumeRunsOnlyWhatIsNotThereOrHasOtherInputs) {
  const std::string out = kPlain + at("out");
  run(at("one.yaml") + out);
  const std::string both = at("one.yaml") + " " + at("two.yaml") + out + " --resume";
  std::string told = run(both);
  EXPECT_THAT(told_of("pass one", told), HasSubstr("done before"));
  EXPECT_THAT(told_of("pass two", told), Not(HasSubstr("done before")));
  write("one", 3);
  told = run(both);
  EXPECT_THAT(told_of("pass one", told), Not(HasSubstr("done before"))) << "another seed";
  EXPECT_THAT(told_of("pass two", told), HasSubstr("done before"));
  write("one", 3, "0.0001");
  told = run(both, 1);
  EXPECT_THAT(told_of("FAIL one", told), HasSubstr("done before")) << "judged again, not run again";
  EXPECT_THAT(run(at("one.yaml") + " --resume", 2), HasSubstr("--resume needs --out"));
}

class ExtendedScenarioRuns : public ScenarioRuns {};

TEST_F(ExtendedScenarioRuns, ResumeTakesTheResultOfAStudyWhoseCommandAndFilesAreTheSame) {
  const auto study = [&](const std::string& command) {
    folder_.write("study.yaml", "name: study\ndescription: d\nsource: s\ncommand: " + command +
                                    "\nexpect:\n  - {metric: exit_status, equals: 0, source: a test}\n");
  };
  const std::string words = at("study.yaml") + " --resume --out " + at("out");
  study("sweep one.yaml --samples 2");
  EXPECT_THAT(run(words), Not(HasSubstr("done before")));
  EXPECT_THAT(run(words), HasSubstr("done before"));
  study("sweep one.yaml --samples 3");
  EXPECT_THAT(run(words), Not(HasSubstr("done before"))) << "another command";
  write("one", 5);
  EXPECT_THAT(run(words), Not(HasSubstr("done before"))) << "another seed in the file that it names";
  folder_.write("line.gcode", read_file(at("line.gcode")) + "; a comment\n");
  EXPECT_THAT(run(words), Not(HasSubstr("done before"))) << "another program of that file";
}

TEST_F(ScenarioRuns, ABaselineShowsWhatDiffers) {
  run(at("one.yaml") + kPlain + at("before"));
  EXPECT_THAT(run(at("one.yaml") + " --baseline " + at("before")), Not(HasSubstr("diff")));
  write("one", 9);
  EXPECT_THAT(run(at("one.yaml") + " --baseline " + at("before")), HasSubstr("diff gap.start_mm was "));
  EXPECT_THAT(run(at("two.yaml") + " --baseline " + at("before"), 2),
              HasSubstr("none of these scenarios has a result there"));
}

TEST_F(ScenarioRuns, GoldenFiguresAreWrittenHeldAndKept) {
  EXPECT_THAT(run(at("one.yaml") + " --update-golden"), HasSubstr("golden/one.yaml"));
  const std::string golden = read_file(at("golden/one.yaml"));
  EXPECT_THAT(golden, HasSubstr("metric: \"gap.start_mm\", equals: 0."));
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
  const std::string told = run(at("one.yaml") + " --junit " + at("j.xml") + kPlain + at("out"), 1);
  EXPECT_THAT(told, HasSubstr("alone: understudy scenario run " + at("one.yaml")));
  EXPECT_THAT(read_file(at("j.xml")), HasSubstr(at("out/one/report.html")));
  EXPECT_THAT(read_file(at("out/index.html")), HasSubstr("one/report.html"));
  run(at("one.yaml") + kPlain + at("out"), 1);
  EXPECT_THAT(read_file(at("out/index.html")), HasSubstr("in 2 runs"));
}

TEST_F(ScenarioRuns, ACommandsFiguresAreHeldToTheirBounds) {
  const auto study = [&](const std::string& command, const std::string& expectation) {
    folder_.write("study.yaml", "name: study\ndescription: d\nsource: s\ncommand: " + command +
                                    "\nexpect:\n  - {" + expectation + ", source: a test}\n");
    return at("study.yaml");
  };
  const std::string workspace = "workspace --step 10";
  const std::string reachable = "metric: workspace.reachable.fraction, ";
  EXPECT_THAT(run(study(workspace, reachable + "min: 0.5, max: 0.6") + " --out " + at("out")),
              HasSubstr("ok   workspace.reachable.fraction in 0.5..0.6"));
  EXPECT_TRUE(fs::exists(at("out/study/workspace.png")));
  EXPECT_THAT(run(study(workspace, reachable + "min: 0.9"), 1), HasSubstr("below 0.9"));
  EXPECT_THAT(run(study(workspace, "metric: workspace.machine, word: hexapod")), HasSubstr("1 passed"));
  EXPECT_THAT(run(study(workspace, "metric: workspace.reachable.friction, min: 0"), 1),
              HasSubstr("workspace.reachable.friction is absent from the result"));
  EXPECT_THAT(run(study("workspace --tilt 500", reachable + "min: 0.5"), 2),
              HasSubstr("study.yaml: command: --tilt 500 deg is outside 0..180 deg"));
  EXPECT_THAT(run(study("workspace --out elsewhere", reachable + "min: 0.5"), 2), HasSubstr("leave it out"));
  EXPECT_THAT(run(study("calibrate a.csv", reachable + "min: 0.5"), 2),
              HasSubstr("'calibrate' is none of the studies"));
  EXPECT_EQ(understudy("sweep " + at("study.yaml")).status, 2);
}

TEST_F(ExtendedScenarioRuns, PicturesAreDrawnUnlessTheyAreLeftOut) {
  const std::string both = at("one.yaml") + " " + at("two.yaml");
  run(at("one.yaml") + " --out " + at("drawn"));
  EXPECT_TRUE(fs::exists(at("drawn/one/pictures/picture-01.png")));
  EXPECT_THAT(read_file(at("drawn/index.html")), HasSubstr("one/pictures/picture-01.png"));
  run(both + " --processes 2" + kPlain + at("plain"));
  EXPECT_FALSE(fs::exists(at("plain/one/pictures")));
  EXPECT_TRUE(fs::exists(at("plain/one/report.html")));
  EXPECT_THAT(read_file(at("plain/index.html")), Not(HasSubstr("picture-01.png")));
  EXPECT_EQ(read_file(at("drawn/one/trace.csv")), read_file(at("plain/one/trace.csv")));
  EXPECT_THAT(run(both + " --no-pictures", 2), HasSubstr("--no-pictures requires --out"));
}

TEST_F(ScenarioRuns, APageThatIsNotOursStays) {
  fs::create_directory(at("out"));
  folder_.write("out/index.html", "<html>mine</html>");
  EXPECT_THAT(run(at("one.yaml") + " --out " + at("out"), 2), HasSubstr("is no index of scenarios"));
  EXPECT_EQ(read_file(at("out/index.html")), "<html>mine</html>");
}

}  // namespace
}  // namespace understudy::cli_test
