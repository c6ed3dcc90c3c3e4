#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/output_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kSource = UNDERSTUDY_SOURCE_DIR;

/// The shipped scenario with one replacement, in a folder of its own.
std::string changed(const Folder& folder, const std::string& what, const std::string& by) {
  std::string yaml = read_file(kSource + "/scenarios/song-bottle.yaml");
  yaml.replace(yaml.find("program: song-bottle.gcode"), 26,
               "program: " + kSource + "/scenarios/song-bottle.gcode");
  const auto at = yaml.find(what);
  EXPECT_NE(at, std::string::npos);
  yaml.replace(at, what.size(), by);
  return folder.write("changed.yaml", yaml);
}

TEST(ScenarioRun, EveryShippedScenarioHoldsWhatIsExpectedOfIt) {
  const Folder folder;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource + "/scenarios"))
    count += entry.path().extension() == ".yaml" ? 1 : 0;
  EXPECT_GE(count, 5);  // the bottle, two faults on it, the arm, the five-axis printer
  const Outcome outcome =
      understudy("scenario run " + kSource + "/scenarios --junit " + (folder / "junit.xml"));
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(std::to_string(count) + " passed, 0 failed"));
  EXPECT_THAT(read_file(folder / "junit.xml"), HasSubstr("<testsuite"));
}

TEST(ScenarioRun, AnExpectationThatFailsIsStatusOneAndSaysByHowMuch) {
  const Folder folder;
  const auto file =
      changed(folder, "metric: gap.start_mm, min: 0.1, max: 0.2", "metric: gap.start_mm, min: 0.5, max: 0.6");
  const Outcome outcome = understudy("scenario run " + file + " --junit " + (folder / "junit.xml"));
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("below 0.5 mm"));
  EXPECT_THAT(read_file(folder / "junit.xml"), HasSubstr("<failure"));
}

TEST(ScenarioRun, BadScenariosAreRefusedBeforeAnythingRuns) {
  const Folder folder;
  const Outcome key = understudy("scenario run " + changed(folder, "gap_control:", "gap_controll:"));
  EXPECT_EQ(key.status, 2);
  EXPECT_THAT(key.err, HasSubstr("gap_control"));
  const Outcome metric =
      understudy("scenario run " + changed(folder, "metric: gap.start_mm", "metric: gap.strat_mm"));
  EXPECT_EQ(metric.status, 2);
  EXPECT_THAT(metric.err, HasSubstr("gap.start_mm"));
  EXPECT_EQ(understudy("scenario run " + (folder / "none.yaml")).status, 2);
}

// 200 machines, both ways: minutes. The table is `understudy sweep scenarios/song-bottle.yaml`.
TEST(SlowScenarioRun, TwoHundredMachinesStartInTheBandAndNoneTouches) {
  const Outcome outcome = understudy("scenario run " + kSource + "/scenarios/studies/song-bottle-200.yaml");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

// Song 2015, figure 17: a minute.
TEST(SlowScenarioRun, AConformalFinishIsATenthOfTheStaircase) {
  const std::string folder = kSource + "/scenarios/surface-finish/";
  const Outcome outcome = understudy("scenario run " + folder + "planar.yaml " + folder + "conformal.yaml");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

// Ishak 2018: struts of 5 mm in the air.
TEST(SlowScenarioRun, ALatticeOfFiveMillimetresStands) {
  const Outcome outcome = understudy("scenario run " + kSource + "/scenarios/lattice-box.yaml");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

TEST(ScenarioList, NamesTheShippedScenarios) {
  const Outcome outcome = understudy("scenario list " + kSource + "/scenarios");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name :
       {"song-bottle", "song-bottle-lost-steps", "song-bottle-warm-strut", "arm-square", "five-axis-tilted"})
    EXPECT_THAT(outcome.out, HasSubstr(name));
}

TEST(Sweep, DoesNotDependOnTheNumberOfThreads) {
  const Folder folder;
  const std::string scenario = kSource + "/scenarios/song-bottle.yaml --samples 3 ";
  ASSERT_EQ(understudy("sweep " + scenario + "-j 1 --out " + (folder / "one")).status, 0);
  ASSERT_EQ(understudy("sweep " + scenario + "-j 3 --out " + (folder / "three")).status, 0);
  EXPECT_EQ(read_file(folder / "one/sweep.csv"), read_file(folder / "three/sweep.csv"));
}

}  // namespace
}  // namespace understudy::cli_test
