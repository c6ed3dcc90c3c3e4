#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

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

/// Of scenarios/papers, on both cores.
void run_papers(const std::vector<std::string>& names) {
  std::string files;
  for (const std::string& name : names) files += " " + kSource + "/scenarios/papers/" + name + ".yaml";
  const Outcome outcome = understudy("scenario run" + files + " --processes 2");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(std::to_string(names.size()) + " passed, 0 failed"));
}

TEST(PaperScenarios, HansCylinderHoldsWhatIsExpectedOfIt) { run_papers({"han-cylinder"}); }

TEST(ExtendedPaperScenarios, HansOtherPartsHoldWhatIsExpectedOfThem) {
  run_papers({"han-rectangle", "han-s"});
}

TEST(ExtendedPaperScenarios, PartsWithTwoBendsHoldWhatIsExpectedOfThem) {
  run_papers({"han-two-bends-bar", "han-two-bends-oval", "han-two-bends-round", "han-side-level"});
}

TEST(PaperScenarios, AreAllRun) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource + "/scenarios/papers"))
    files += entry.path().extension() == ".yaml" ? 1 : 0;
  EXPECT_EQ(files, 7) << "name a new one in a test above";
}

// Which kinds there must be: tests/regression/limits_and_faults_test.cpp.
TEST(ScenarioRun, EachLimitAndEachFaultIsFoundOnItsLine) {
  const Outcome outcome = understudy("scenario run " + kSource + "/scenarios/limits --processes 2");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("35 passed, 0 failed"));
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

/// A scenario on the five-axis printer; `what` is its program or plan.
std::string bent(const Folder& folder, const std::string& file, const std::string& what,
                 const std::string& expect) {
  return folder.write(
      file, "name: " + file + "\ndescription: a bent part\nsource: none\nmachine: five-axis\n" + what +
                "\nas_built: nominal\nseed: 1\ngap_control: \"off\"\nengine: quasistatic\nexpect:\n  - {" +
                expect + ", source: a test}\n");
}

TEST(ExtendedScenarioRun, APlanStandsForTheProgramThatItMakes) {
  const Folder folder;
  std::filesystem::copy_file(kSource + "/models/parts/bent_bar.stl", folder / "bar.stl");
  const std::string words = "support-free bar.stl --layer 0.8 --layer-range 0.4,1.0 --width 2";
  const auto file = bent(folder, "bar.yaml", "plan: " + words, "metric: print.duration_s, min: 60, unit: s");
  const Outcome planned = understudy("scenario run " + file + " --out " + (folder / "out"));
  ASSERT_EQ(planned.status, 0) << planned.out << planned.err;
  EXPECT_EQ(planned.out.find("planned.gcode"), std::string::npos) << "only the scenario's own lines";
  const std::string program = read_file(folder / "out/bar/planned.gcode");
  EXPECT_THAT(program, ::testing::StartsWith("; planned by: understudy plan " + words));
  const auto lines_after_first = [](const std::string& text) { return text.substr(text.find('\n')); };
  ASSERT_EQ(understudy("plan support-free " + (folder / "bar.stl") +
                       " --layer 0.8 --layer-range 0.4,1.0 --width 2 --machine five-axis -o " +
                       (folder / "direct.gcode"))
                .status,
            0);
  EXPECT_EQ(lines_after_first(program), lines_after_first(read_file(folder / "direct.gcode")));
}

TEST(ScenarioRun, APlanThatIsRefusedIsARunWithStatusTwo) {
  const Folder folder;
  const std::string refused = "plan: support-free none.stl";
  EXPECT_EQ(
      understudy("scenario run " + bent(folder, "a.yaml", refused, "metric: exit_status, equals: 2")).status,
      0);
  const Outcome outcome =
      understudy("scenario run " + bent(folder, "b.yaml", refused, "metric: verdict, equals: go"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, HasSubstr("b.yaml: plan: "));
  EXPECT_THAT(outcome.out, HasSubstr("none.stl"));
  for (const std::string words :
       {"spiral -o x.gcode", "spiral -ox.gcode", "spiral --machine arm", "spirale", "spiral --radiuss 3"}) {
    const Outcome wrong =
        understudy("scenario run " + bent(folder, "c.yaml", "plan: " + words, "metric: verdict, equals: go"));
    EXPECT_EQ(wrong.status, 2) << words;
    EXPECT_THAT(wrong.out, HasSubstr("c.yaml: plan: ")) << words;
  }
}

// A scenario may come from a stranger: it shall not overwrite a file of the user.
TEST(ScenarioRun, APlanWritesItsProgramAlone) {
  const Folder folder;
  const std::string others = folder.write("others.stl", "mine");
  for (const std::string option : {"--stock ", "--stock="}) {
    const auto file = folder.write(
        "mill.yaml",
        "name: mill\ndescription: a cross\nsource: none\nmachine: finishing\nplan: finishing cross_90 "
        "--from 22 " +
            option + others +
            "\nas_built: nominal\nseed: 1\ngap_control: \"off\"\nengine: quasistatic\nexpect:\n"
            "  - {metric: verdict, equals: go, source: a test}\n");
    const Outcome outcome = understudy("scenario run " + file);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.out, HasSubstr("writes a file")) << option;
    EXPECT_EQ(read_file(others), "mine");
  }
}

TEST(ScenarioRun, TwoScenariosOfOneNameAreRefused) {
  const Folder folder;
  const auto one = changed(folder, "engine: mujoco", "engine: quasistatic");
  const Outcome outcome = understudy("scenario run " + one + " " + one);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("are both named 'song-bottle'"));
}

/// The shipped finish of an ellipse with one replacement.
std::string finishing_with(const Folder& folder, const std::string& what, const std::string& by) {
  std::string yaml = read_file(kSource + "/scenarios/yu-ellipse-1.yaml");
  if (what != "program: finishing/")
    yaml.replace(yaml.find("program: finishing/"), 19, "program: " + kSource + "/scenarios/finishing/");
  const auto at = yaml.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  yaml.replace(at, what.size(), by);
  return folder.write("finishing.yaml", yaml);
}

/// Every level tool leans up by 4 degrees: W I J K, a quarter turn about an axis in the plane, becomes 86
/// degrees.
std::string leaning(const std::string& gcode) {
  std::istringstream lines(gcode);
  std::string line, all;
  while (std::getline(lines, line)) {
    if (line.find(" W") != std::string::npos) {
      std::istringstream words(line);
      std::string word, turned;
      while (words >> word) {
        const double value = word.size() > 1 ? std::atof(word.c_str() + 1) : 0;
        if (word[0] == 'W') word = fmt::format("W{:.9f}", std::cos(43 * kDegree));
        if (word[0] == 'I' || word[0] == 'J')
          word = fmt::format("{}{:.9f}", word[0], value * std::sin(43 * kDegree) / std::sqrt(0.5));
        turned += word + " ";
      }
      line = turned;
    }
    all += line + "\n";
  }
  return all;
}

// Each expectation is about something: without that it fails.
TEST(ExtendedScenarioRun, AFinishFailsWithoutStockWithoutPlayAndOnWrongNormals) {
  const Folder folder;
  const auto fails = [&](const std::string& file, const std::string& why) {
    const Outcome outcome = understudy("scenario run " + file);
    EXPECT_EQ(outcome.status, 1) << why << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(why));
  };
  fails(finishing_with(folder, "depth_of_cut_mm: 0.7", "stock: ellipse_50"), "removal.volume_mm3");
  std::string machine = read_file(kSource + "/models/finishing/machine.yaml");
  for (const std::string play : {"play_um: 10", "play_arcmin: 1"})
    for (auto at = machine.find(play); at != std::string::npos; at = machine.find(play))
      machine.replace(at, play.size(), play.substr(0, play.find(':')) + ": 0");
  fails(finishing_with(folder, "machine: finishing", "machine: " + folder.write("stiff.yaml", machine)),
        "removal.gouge_um");
  folder.write("ellipse_50.gcode", leaning(read_file(kSource + "/scenarios/finishing/ellipse_50.gcode")));
  fails(finishing_with(folder, "program: finishing/", "program: "), "removal.gouge_um");
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

TEST(ScenarioRun, WhatCannotBeRehearsedIsBadInputAndNoFailedExpectation) {
  const Folder folder;
  for (const auto& [what, by] :
       {std::pair("fixture: bottle", "fixture: botle"), {"machine: hexapod", "machine: hexapot"}}) {
    const Outcome outcome = understudy("scenario run " + changed(folder, what, by));
    EXPECT_EQ(outcome.status, 2) << by << outcome.out << outcome.err;
  }
}

TEST(ScenarioRun, ResultsThatWouldReplaceEachOtherAreRefusedBeforeAnythingRuns) {
  const Folder folder;
  const auto one = changed(folder, "seed:", "seed:");
  std::filesystem::create_directory(folder.path() / "b");
  std::filesystem::copy(one, folder.path() / "b" / "changed.yaml");
  const std::string both = "scenario run " + one + " " + (folder / "b/changed.yaml");
  const Outcome outcome = understudy(both + " --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("one folder of --out"));
  const Outcome nowhere = understudy(both + " --junit " + (folder / "none/junit.xml"));
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_EQ(nowhere.out, "") << "nothing ran";
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
  for (const char* name : {"song-bottle", "song-bottle-lost-steps", "song-bottle-warm-strut", "arm-square",
                           "five-axis-tilted", "yu-cross-1", "yu-cross-2", "yu-ellipse-1", "yu-ellipse-2"})
    EXPECT_THAT(outcome.out, HasSubstr(name));
}

TEST(ExtendedSweep, DoesNotDependOnTheNumberOfThreads) {
  const Folder folder;
  const std::string scenario = kSource + "/scenarios/song-bottle.yaml --samples 3 ";
  // What is planned needs a folder for temporary files, which a kill would leave behind; a program does not.
  const std::string no_folder = "TMPDIR=" + (folder / "none");
  ASSERT_EQ(understudy_after(no_folder, "sweep " + scenario + "-j 1 --out " + (folder / "one")).status, 0);
  ASSERT_EQ(understudy("sweep " + scenario + "-j 3 --out " + (folder / "three")).status, 0);
  EXPECT_EQ(read_file(folder / "one/sweep.csv"), read_file(folder / "three/sweep.csv"));
}

// Half a millimetre of the line without its approach: all that differs after a calibration is the geometry.
TEST(ExtendedSweep, ABudgetTellsItsCostItsTableAndItsFilesWhateverTheThreads) {
  const Folder folder;
  const std::string program =
      folder.write("line.gcode",
                   "G21\nG90\nM82\nG94\nM109 S230\n"
                   "G0 X-5.34577 Y0 Z30.187397 W0.984807753 I0 J-0.173648178 K0\n"
                   "G1 X-5.112004 Y0 Z30.270181 W0.98615421 I0 J-0.16583086 K0 E0.006035 F300\n"
                   "G1 X-4.876968 Y0 Z30.349281 W0.987438993 I0 J-0.158000744 K0 E0.012069\n");
  std::string yaml = read_file(changed(folder, "engine: mujoco", "engine: quasistatic"));
  const auto replace = [&](const std::string& what, const std::string& by) {
    yaml.replace(yaml.find(what), what.size(), by);
  };
  replace(kSource + "/scenarios/song-bottle.gcode", program);
  replace("gap_control: start", "gap_control: off");
  const std::string scenario = folder.write("line.yaml", yaml);
  const auto run = [&](const std::string& threads) {
    return understudy("sweep " + scenario + " --budget --samples 8 -j " + threads + " --out " +
                      (folder / threads));
  };
  const Outcome one = run("1"), two = run("2");
  ASSERT_EQ(one.status, 0) << one.err;
  ASSERT_EQ(two.status, 0) << two.err;
  EXPECT_THAT(one.err, HasSubstr("8 samples x (1 group + 2) = 24 rehearsals"));
  EXPECT_THAT(one.out, HasSubstr("geometry    " + std::string(" 1.00 [ 1.00,  1.00]")));
  EXPECT_THAT(one.out, HasSubstr("understudy calibrate"));
  for (const char* file : {"/budget.csv", "/runs.csv"})
    EXPECT_EQ(read_file((folder / "1") + file), read_file((folder / "2") + file));
  EXPECT_THAT(read_file((folder / "1") + "/budget.html"), HasSubstr("<svg"));
  EXPECT_THAT(read_file((folder / "1") + "/budget.json"), HasSubstr("understudy.budget/1"));
}

}  // namespace
}  // namespace understudy::cli_test
