#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "regression/scenario_file.h"
#include "tests/temporary_folder.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

const char kHead[] =
    "name: song-bottle\n"
    "description: the curved line on a bottle\n"
    "source: Song 2015, section 6.2\n"
    "machine: hexapod\n"
    "program: ../parts/line.gcode\n"
    "fixture: ../parts/bottle.stl\n"
    "as_built: sampled\n"
    "seed: 1\n"
    "gap_control: start\n"
    "engine: mujoco\n";
const char kExpect[] =
    "expect:\n"
    "  - {metric: verdict, equals: go, source: the paper printed it}\n"
    "  - {metric: gap.start_mm, min: 0.1, max: 0.2, unit: mm, source: \"Song 2015, 3.3\"}\n";
const char kMachines[] =
    "machines:\n"
    "  seeds: 1-200\n"
    "  expect:\n"
    "    - metric: gap.start_mm\n"
    "      statistic: fraction_within\n"
    "      within: [0.1, 0.2]\n"
    "      min: 0.99\n"
    "      unit: mm\n"
    "      source: requirement\n";

class ScenarioFile : public testing::Test {
 protected:
  ScenarioFile() {
    fs::create_directories(root_ / "scenarios");
    fs::create_directories(root_ / "parts");
    write_file(root_ / "parts/line.gcode", "G28\n");
    write_file(root_ / "parts/bottle.stl", "solid\n");
  }

  Scenario load(const std::string& text) {
    const fs::path path = root_ / "scenarios/s.yaml";
    write_file(path, text);
    return load_scenario(path);
  }
  std::string error_of(const std::string& text) {
    try {
      load(text);
    } catch (const InputError& error) {
      return fs::path(error.place().file).filename().string() + ":" + std::to_string(error.place().line) +
             " " + error.what();
    }
    return "no error";
  }
  // The good file with one expectation in place of the others; it stands in line 12.
  std::string error_of_expectation(const std::string& fields) {
    return error_of(std::string(kHead) + "expect:\n  - {" + fields + ", source: x}\n");
  }

  const TemporaryFolder root_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(ScenarioFile, HasAProgramOrAPlanOfOne) {
  const std::string good = std::string(kHead) + kExpect;
  const Scenario planned =
      load(replaced(good, "program: ../parts/line.gcode", "plan: planar ../parts/box.stl --layer 0.2"));
  EXPECT_EQ(planned.plan, "planar ../parts/box.stl --layer 0.2");
  EXPECT_TRUE(planned.program.empty());
  EXPECT_THAT(error_of(replaced(good, "fixture:", "plan: spiral\nfixture:")),
              AllOf(HasSubstr("s.yaml:6"), HasSubstr("exclude each other")));
  EXPECT_THAT(error_of(replaced(good, "program: ../parts/line.gcode\n", "")), HasSubstr("program"));
}

TEST_F(ScenarioFile, ThePartIsRegisteredWhereTheFileSaysSo) {
  const std::string head = kHead, rest = kExpect;
  EXPECT_FALSE(load(head + rest).registration.wanted);
  const Scenario chosen = load(head + "register: {places: 12}\n" + rest);
  EXPECT_TRUE(chosen.registration.wanted);
  EXPECT_EQ(chosen.registration.places, 12);
  EXPECT_TRUE(load(head + "register: {}\n" + rest).registration.wanted);
  write_file(root_ / "parts/places.csv", "x_mm,y_mm,z_mm\n");
  const Scenario given = load(head + "register: {pattern: ../parts/places.csv}\n" + rest);
  EXPECT_EQ(given.registration.pattern, (root_ / "parts/places.csv").string());
  EXPECT_THAT(error_of(head + "register: {places: 5}\n" + rest),
              testing::HasSubstr("register.places is 5, outside 6 to 100"));
  EXPECT_THAT(error_of(head + "register: {pattern: none.csv}\n" + rest),
              testing::HasSubstr("does not exist"));
  EXPECT_THAT(error_of(head + "register: {pattern: ../parts/places.csv, places: 9}\n" + rest),
              testing::HasSubstr("the pattern has its own"));
}

TEST_F(ScenarioFile, ReadsEveryField) {
  const Scenario s = load(std::string(kHead) + kExpect + kMachines);
  EXPECT_EQ(s.name, "song-bottle");
  EXPECT_EQ(s.machine, "hexapod");
  EXPECT_EQ(s.program, root_ / "parts/line.gcode");
  EXPECT_EQ(s.fixture, (root_ / "parts/bottle.stl").string());
  EXPECT_EQ(s.as_built, "sampled");
  EXPECT_EQ(s.seed, 1u);
  EXPECT_EQ(s.gap_control, "start");
  EXPECT_EQ(s.engine, "mujoco");
  ASSERT_EQ(s.expect.size(), 2u);
  EXPECT_EQ(std::get<std::string>(*s.expect[0].equals), "go");
  EXPECT_EQ(s.expect[1].min, 0.1);
  EXPECT_EQ(s.expect[1].max, 0.2);
  EXPECT_EQ(s.expect[1].source, "Song 2015, 3.3");
  EXPECT_EQ(s.expect[1].line, 13);
  ASSERT_TRUE(s.machines);
  EXPECT_EQ(s.machines->count(), 200u);
  EXPECT_EQ(s.machines->expect[0].statistic, Statistic::fraction_within);
  EXPECT_EQ(s.machines->expect[0].within_max, 0.2);
}

TEST_F(ScenarioFile, AMisspeltKeyNamesItsLineAndTheNearestKey) {
  const std::string good = std::string(kHead) + kExpect + kMachines;
  EXPECT_THAT(error_of(replaced(good, "gap_control:", "gap_controll:")),
              AllOf(StartsWith("s.yaml:9 "), HasSubstr("gap_controll"), HasSubstr("'gap_control'")));
  EXPECT_THAT(error_of(replaced(good, "fixture:", "fixtur:")),
              AllOf(StartsWith("s.yaml:6 "), HasSubstr("did you mean 'fixture'")));
  EXPECT_THAT(error_of(replaced(good, "max: 0.2, ", "maxx: 0.2, ")),
              AllOf(StartsWith("s.yaml:13 "), HasSubstr("did you mean 'max'")));
  EXPECT_THAT(error_of(replaced(good, "  seeds:", "  seed:")),
              AllOf(StartsWith("s.yaml:15 "), HasSubstr("did you mean 'seeds'")));
}

TEST_F(ScenarioFile, EveryMissingKeyIsNamed) {
  for (const char* key :
       {"name", "description", "source", "machine", "program", "as_built", "seed", "gap_control", "engine"}) {
    std::string text = std::string("\n") + kHead + kExpect;
    const std::size_t at = text.find(std::string("\n") + key + ":") + 1;
    text.erase(at, text.find('\n', at) + 1 - at);
    EXPECT_THAT(error_of(text), HasSubstr(std::string("key '") + key + "' is missing"));
  }
  EXPECT_THAT(error_of(kHead), HasSubstr("key 'expect' is missing"));
}

TEST_F(ScenarioFile, AScenarioThatExpectsNothingIsAnError) {
  EXPECT_THAT(error_of(std::string(kHead) + "expect: []\n"),
              AllOf(StartsWith("s.yaml:11 "), HasSubstr("at least one entry")));
  EXPECT_THAT(error_of(std::string(kHead) + "expect:\n"), HasSubstr("at least one entry"));
}

TEST_F(ScenarioFile, AFileThatIsNotThereIsNamed) {
  const std::string good = std::string(kHead) + kExpect;
  EXPECT_THAT(error_of(replaced(good, "line.gcode", "lin.gcode")),
              AllOf(StartsWith("s.yaml:5 "), HasSubstr("parts/lin.gcode"), HasSubstr("does not exist")));
  EXPECT_THAT(error_of(replaced(good, "bottle.stl", "bottl.stl")), StartsWith("s.yaml:6 "));
  EXPECT_THAT(error_of(replaced(good, "machine: hexapod", "machine: ./hexapod/machine.yaml")),
              StartsWith("s.yaml:4 "));
  EXPECT_THAT(error_of(replaced(good, "as_built: sampled", "as_built: built.yaml")), StartsWith("s.yaml:7 "));
  EXPECT_THAT(error_of(replaced(good, "../parts/line.gcode", "../parts")), HasSubstr("is not a file"));
}

TEST_F(ScenarioFile, UnknownWordsNameTheNearest) {
  const std::string good = std::string(kHead) + kExpect;
  EXPECT_THAT(error_of(replaced(good, "as_built: sampled", "as_built: sampeld")),
              HasSubstr("did you mean 'sampled'"));
  EXPECT_THAT(error_of(replaced(good, "gap_control: start", "gap_control: always")),
              HasSubstr("off, start, continuous"));
  EXPECT_THAT(error_of(replaced(good, "engine: mujoco", "engine: mojoco")),
              HasSubstr("did you mean 'mujoco'"));
  EXPECT_THAT(error_of_expectation("metric: verdict, equals: nogo"), HasSubstr("did you mean 'no-go'"));
  EXPECT_THAT(error_of_expectation("metric: gap.strat_mm, max: 1, unit: mm"),
              AllOf(StartsWith("s.yaml:12 "), HasSubstr("did you mean 'gap.start_mm'")));
}

TEST_F(ScenarioFile, ABoundMustBeANumber) {
  for (const char* value : {"", "small", "\"0.1\"", ".nan", ".inf", "0.1mm", "1e999", "[1]"})
    EXPECT_THAT(error_of(std::string(kHead) + "expect:\n  - metric: gap.start_mm\n    min: " + value +
                         "\n    unit: mm\n    source: x\n"),
                AllOf(StartsWith("s.yaml:13"),
                      AnyOf(HasSubstr("where a number is expected"), HasSubstr("not finite"))))
        << value;
}

TEST_F(ScenarioFile, AnExpectationNeedsABoundThatMakesSense) {
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, unit: mm"), HasSubstr("has no bound"));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, unit: mm, min: 2, max: 1"),
              HasSubstr("min 2 is above max 1"));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, unit: mm, min: 2, equals: 1"),
              HasSubstr("excludes"));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, unit: mm, min: 2, tolerance: 1"),
              HasSubstr("'equals' only"));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, unit: mm, equals: 2, tolerance: -1"),
              HasSubstr("below 0"));
  EXPECT_THAT(error_of_expectation("metric: verdict, min: 1"), HasSubstr("is a word"));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, statistic: max, max: 1, unit: mm"),
              HasSubstr("'machines'"));
}

TEST_F(ScenarioFile, TheUnitMustBeTheMetrics) {
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, max: 200, unit: um"),
              AllOf(StartsWith("s.yaml:12 "), HasSubstr("gap.start_mm is in mm, not in um")));
  EXPECT_THAT(error_of_expectation("metric: gap.start_mm, max: 0.2"), HasSubstr("lacks its unit: mm"));
  EXPECT_THAT(error_of_expectation("metric: findings.count, max: 0, unit: mm"), HasSubstr("no unit"));
  EXPECT_EQ(error_of_expectation("metric: findings.count, max: 0, unit: 1"), "no error");
  EXPECT_EQ(error_of_expectation("metric: gap.in_band_fraction, min: 0.9"), "no error");
}

TEST_F(ScenarioFile, ABoundWithoutASourceIsAnError) {
  EXPECT_THAT(error_of(std::string(kHead) + "expect:\n  - {metric: verdict, equals: go}\n"),
              AllOf(StartsWith("s.yaml:12 "), HasSubstr("key 'expect[1].source' is missing")));
}

TEST_F(ScenarioFile, SeedsAreARangeThatRunsForward) {
  const std::string good = std::string(kHead) + kExpect + kMachines;
  for (const char* seeds : {"200", "1-", "-5", "a-b", "1-200x", "1..200"})
    EXPECT_THAT(error_of(replaced(good, "1-200", seeds)), AllOf(StartsWith("s.yaml:15 "), HasSubstr("range")))
        << seeds;
  EXPECT_THAT(error_of(replaced(good, "1-200", "9-3")), HasSubstr("backwards"));
  EXPECT_THAT(error_of(replaced(good, "1-200", "1-99999999")), HasSubstr("more than"));
  EXPECT_EQ(load(replaced(good, "1-200", "7-7")).machines->count(), 1u);
  EXPECT_THAT(error_of(replaced(good, "seed: 1\n", "seed: -1\n")), HasSubstr("whole number"));
}

TEST_F(ScenarioFile, StatisticsSayWhatTheyNeed) {
  const std::string good = std::string(kHead) + kExpect + kMachines;
  EXPECT_THAT(error_of(replaced(good, "within: [0.1, 0.2]", "within: [0.2, 0.1]")), HasSubstr("above"));
  EXPECT_THAT(error_of(replaced(good, "within: [0.1, 0.2]", "within: [0.2]")),
              HasSubstr("list of 2 numbers"));
  EXPECT_THAT(error_of(replaced(good, "min: 0.99", "min: 99")), HasSubstr("min is 99, outside 0 to 1"));
  EXPECT_THAT(error_of(replaced(good, "fraction_within", "p95")), HasSubstr("fraction_within only"));
  EXPECT_THAT(error_of(replaced(good, "fraction_within", "average")), HasSubstr("one of"));
  EXPECT_THAT(error_of(replaced(good, "      statistic: fraction_within\n", "")),
              HasSubstr("'within' goes with the statistic fraction_within only"));
}

TEST_F(ScenarioFile, FiguresOfASeriesAreRefusedForASingleRun) {
  EXPECT_THAT(error_of_expectation("metric: approach.min_gap_mm, min: 0, unit: mm"),
              HasSubstr("'machines' only"));
  const std::string good = std::string(kHead) + kExpect + kMachines;
  EXPECT_EQ(error_of(replaced(good, "- metric: gap.start_mm", "- metric: approach.min_gap_mm")), "no error");
}

TEST_F(ScenarioFile, FilesThatAreNoScenariosAreRefused) {
  EXPECT_THAT(error_of(""), HasSubstr("empty"));
  EXPECT_THAT(error_of("just words"), HasSubstr("where keys with values are expected"));
  EXPECT_THAT(error_of("a: [1, 2\nb: }"), HasSubstr("not YAML"));
  EXPECT_THAT(error_of(std::string(kHead) + "seed: 2\n" + kExpect),
              AllOf(StartsWith("s.yaml:11 "), HasSubstr("twice")));
  EXPECT_THAT(error_of(std::string(kHead) + kExpect + "---\na: 1\n"), HasSubstr("2 documents"));
  EXPECT_THROW(load_scenario(root_ / "nothing.yaml"), InputError);
}

TEST_F(ScenarioFile, FoldersGiveTheirScenariosSorted) {
  for (const char* name : {"b.yaml", "a.yaml", "notes.txt"}) write_file(root_ / "scenarios" / name, "x: 1\n");
  const fs::path folder[] = {root_ / "scenarios"};
  EXPECT_THAT(find_scenarios(folder),
              testing::ElementsAre(root_ / "scenarios/a.yaml", root_ / "scenarios/b.yaml"));
  const fs::path empty[] = {root_ / "parts"}, missing[] = {root_ / "missing"};
  EXPECT_THROW(find_scenarios(empty), InputError);
  EXPECT_THROW(find_scenarios(missing), InputError);
}

}  // namespace
}  // namespace understudy::regression
