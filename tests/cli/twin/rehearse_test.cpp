#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kBottle = "rehearse " + kSource + "/scenarios/song-bottle.gcode --fixture bottle ";

/// The summary without what names the output folder.
std::string comparable(const std::string& summary) {
  auto json = nlohmann::json::parse(summary);
  json["provenance"].erase("command");
  return json.dump();
}

TEST(Rehearse, WritesTheContractsFilesAndAnswersByExitStatus) {
  const Folder folder;
  const Outcome outcome = understudy(kBottle + "--out " + (folder / "out"));
  ASSERT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.err;
  EXPECT_EQ(without_progress(outcome.err), "");
  EXPECT_EQ(folder.entries(), 1);
  for (const char* name : {"summary.json", "report.html", "trace.csv", "frames"})
    EXPECT_TRUE(fs::exists(folder.path() / "out" / name)) << name;
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "out" / "summary.json"));
  EXPECT_EQ(summary["schema"], "understudy.rehearsal/1");
  EXPECT_EQ(summary["verdict"], outcome.status == 0 ? "go" : "no-go");
  EXPECT_GE(summary["gap"]["start_mm"], 0.1);
  EXPECT_LE(summary["gap"]["start_mm"], 0.2);
  EXPECT_EQ(summary["provenance"]["machine_sha256"].get<std::string>().size(), 64u);
  const auto timing = nlohmann::json::parse(read_file(folder.path() / "out" / "timing.json"));
  EXPECT_GT(timing["to_first_setpoint_s"], 0);
  EXPECT_LT(timing["to_first_setpoint_s"], 60) << "from the start of the process, not of the computer";
  EXPECT_THAT(outcome.out, HasSubstr("report.html"));
}

/// A short print on the table.
class RehearseTells : public testing::Test {
 protected:
  Outcome rehearse(const std::string& options) const {
    return understudy("rehearse " + program_ + " --engine quasistatic --gap-control off --no-pictures " +
                      "--tip-tolerance 5 --out " + (folder_ / "out") + " " + options);
  }
  Folder folder_;
  std::string program_ = folder_.write(
      "line.gcode", "G21 G90 M83\nM104 S200\nG0 X-3 Y0 Z1\nG1 Z0.15 F600\nG1 X3 E0.2 F300\nG0 Z2\n");
};

TEST_F(RehearseTells, TheVerdictAloneWhenQuiet) {
  const Outcome told = rehearse("--quiet"), at_length = rehearse("");
  EXPECT_EQ(told.out, at_length.out.substr(0, at_length.out.find('\n') + 1));
  EXPECT_EQ(std::ranges::count(told.out, '\n'), 1) << told.out;
  EXPECT_THAT(told.out, HasSubstr("line.gcode on hexapod: "));
  EXPECT_EQ(told.err, "");
  EXPECT_EQ(told.status, at_length.status);
  EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
}

TEST_F(RehearseTells, TheSummaryAsOneDocument) {
  const Outcome told = rehearse("--json -q");
  EXPECT_EQ(told.out, read_file(folder_ / "out/summary.json"));
  EXPECT_EQ(nlohmann::json::parse(told.out)["schema"], "understudy.rehearsal/1");
  EXPECT_EQ(understudy("verify " + (folder_ / "out")).status, 0) << "its words are read again";
}

TEST_F(RehearseTells, ErrorsOnStandardErrorWhateverIsAsked) {
  const Outcome told = rehearse("--json --quiet --machine none");
  EXPECT_EQ(told.status, 2);
  EXPECT_EQ(told.out, "");
  EXPECT_THAT(told.err, HasSubstr("none"));
}

TEST(ExtendedRehearse, TheSameCommandAndSeedGiveTheSameBytes) {
  const Folder folder;
  ASSERT_LE(understudy(kBottle + "--seed 5 --out " + (folder / "a")).status, 1);
  ASSERT_LE(understudy(kBottle + "--seed 5 --out " + (folder / "b")).status, 1);
  EXPECT_EQ(comparable(read_file(folder / "a/summary.json")),
            comparable(read_file(folder / "b/summary.json")));
  EXPECT_EQ(read_file(folder / "a/trace.csv"), read_file(folder / "b/trace.csv"));
  // Another seed is another machine.
  ASSERT_LE(understudy(kBottle + "--seed 6 --no-pictures --out " + (folder / "c")).status, 1);
  EXPECT_NE(read_file(folder / "a/trace.csv"), read_file(folder / "c/trace.csv"));
}

TEST(SlowRehearse, ThreadsOfTheRendererDoNotChangeTheBytes) {
  const Folder folder;
  ::setenv("LP_NUM_THREADS", "1", 1);
  ASSERT_LE(understudy(kBottle + "--seed 5 --out " + (folder / "a")).status, 1);
  ::setenv("LP_NUM_THREADS", "4", 1);
  ASSERT_LE(understudy(kBottle + "--seed 5 --out " + (folder / "b")).status, 1);
  ::unsetenv("LP_NUM_THREADS");
  EXPECT_EQ(comparable(read_file(folder / "a/summary.json")),
            comparable(read_file(folder / "b/summary.json")));
}

TEST(Rehearse, WithoutGapControlTheStartIsOpenLoop) {
  const Folder folder;
  ASSERT_LE(understudy(kBottle + "--seed 5 --no-pictures --out " + (folder / "with")).status, 1);
  ASSERT_LE(
      understudy(kBottle + "--seed 5 --no-pictures --gap-control off --out " + (folder / "without")).status,
      1);
  const auto with = nlohmann::json::parse(read_file(folder / "with/summary.json"));
  const auto without = nlohmann::json::parse(read_file(folder / "without/summary.json"));
  // The same machine, printed without gap control, either way it is asked for.
  EXPECT_EQ(with["gap"]["open_loop_start_mm"], without["gap"]["start_mm"]);
  EXPECT_EQ(without["gap"]["frames"], 0);
  EXPECT_FALSE(without["gap"].contains("open_loop_start_mm"));
}

TEST(Rehearse, APoseOutOfReachIsANoGoThatNamesTheStrutAndHowMuch) {
  const Folder folder;
  const auto file = folder.write("far.gcode", "G21\nG90\nG0 X0 Y0 Z60 W1 I0 J0 K0\nG1 X0 Y0 Z110 F600\n");
  const Outcome outcome = understudy("rehearse " + file + " --no-pictures --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const auto summary = nlohmann::json::parse(read_file(folder / "out/summary.json"));
  EXPECT_EQ(summary["verdict"], "no-go");
  ASSERT_FALSE(summary["findings"].empty());
  const auto& finding = summary["findings"][0];
  EXPECT_EQ(finding["kind"], "strut_length");
  EXPECT_EQ(finding["gcode_line"], 4);
  EXPECT_EQ(finding["unit"], "mm");
  EXPECT_EQ(finding["limit"], 170.0);
  EXPECT_LT(finding["value"], 170.0);
  EXPECT_THAT(finding["message"].get<std::string>(), HasSubstr("strut"));
  EXPECT_THAT(finding["message"].get<std::string>(), HasSubstr("simulated with the axis held at its limit"));
}

// The five-axis printer's z ends at 200 mm: a last line that parks above it hides nothing of the bead before.
TEST(Rehearse, ALimitBrokenOnTheLastLineLeavesTheRestSimulated) {
  const Folder folder;
  const std::string bead =
      "G21\nG90\nM82\nM109 S210\nG0 X0 Y0 Z10\nG1 X0 Y0 Z0.16 F600\nG1 X0 Y20 E0.7 F300\n";
  const auto run = [&](const std::string& name, const std::string& program) {
    const auto file = folder.write(name + ".gcode", program);
    const Outcome outcome =
        understudy("rehearse " + file +
                   " --machine five-axis --as-built nominal --engine quasistatic --no-pictures --out " +
                   (folder / name));
    return std::pair(outcome.status, nlohmann::json::parse(read_file(folder.path() / name / "summary.json")));
  };
  const auto [status, whole] = run("whole", bead + "G0 Z150\n");
  EXPECT_EQ(status, 0);
  const auto [parked_status, parked] = run("parked", bead + "G0 Z230\n");
  EXPECT_EQ(parked_status, 1);
  EXPECT_EQ(parked["findings"][0]["kind"], "joint_limit");
  EXPECT_EQ(parked["findings"][0]["gcode_line"], 8);
  EXPECT_EQ(parked["findings"][0]["limit"], 200);
  EXPECT_EQ(parked["gap"], whole["gap"]);
  EXPECT_EQ(parked["accuracy"], whole["accuracy"]);
  EXPECT_EQ(parked["print"]["printed_mm"], whole["print"]["printed_mm"]);
}

// A line that cannot be read and a bead that no nozzle lays: what they do to the rest is told, not guessed.
TEST(Rehearse, BadLinesAreANoGoThatTellsTheRestAndStrictRefusesThem) {
  const Folder folder;
  const std::string head = "G21\nG90\nM82\nM109 S210\nG0 X0 Y0 Z10\nG1 X0 Y0 Z0.16 F600\n";
  const std::string bead = "G1 X0 Y20 E0.7 F300\n";
  const std::string options =
      " --machine five-axis --as-built nominal --engine quasistatic --no-pictures --out ";
  const auto whole_file = folder.write("whole.gcode", head + bead + "G1 X3\n");
  const auto bad_file =
      folder.write("bad.gcode", head + "M106 S300\n" + bead + "G1 X3 E90\nG1 X1.2.3 Y30 Z50 E91\nG0 Z60\n");
  EXPECT_EQ(understudy("rehearse " + whole_file + options + (folder / "whole")).status, 0);
  const Outcome bad = understudy("rehearse " + bad_file + options + (folder / "bad"));
  EXPECT_EQ(bad.status, 1) << bad.err;
  EXPECT_THAT(bad.out, HasSubstr("NO-GO"));
  EXPECT_THAT(bad.out, HasSubstr("about the program without it: lines 7, 10 to 11\n"));
  EXPECT_THAT(bad.out,
              HasSubstr("line 7 cannot be read: 'S300': the fan's speed is outside 0 to 255; passed over"));
  EXPECT_THAT(bad.out, HasSubstr("line 10 cannot be read: 'X1.2.3'"));
  EXPECT_THAT(bad.out, HasSubstr("simulated without this filament"));
  const auto whole = nlohmann::json::parse(read_file(folder / "whole/summary.json"));
  const auto rest = nlohmann::json::parse(read_file(folder / "bad/summary.json"));
  EXPECT_FALSE(whole.contains("passed_over"));
  EXPECT_EQ(rest["passed_over"].dump(), "[[7,7],[10,11]]");
  EXPECT_EQ(rest["gap"], whole["gap"]);
  EXPECT_EQ(rest["print"]["printed_mm"], whole["print"]["printed_mm"]);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rest["findings"][i]["kind"], "program");
  EXPECT_THAT(read_file(folder / "bad/report.html"),
              HasSubstr("All figures are of the program without lines 7 and 10 to 11"));

  const Outcome strict = understudy("rehearse " + bad_file + " --strict" + options + (folder / "strict"));
  EXPECT_EQ(strict.status, 2);
  EXPECT_THAT(strict.err, HasSubstr("bad.gcode:7:6: 'S300'"));
  EXPECT_THAT(strict.err, HasSubstr("line 10: 'X1.2.3'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "strict"));
}

TEST(Rehearse, ATipErrorBeyondTheToleranceIsANoGo) {
  const Folder folder;
  const std::string command =
      "rehearse " + kSource +
      "/scenarios/arm-square.gcode --machine arm --engine quasistatic --as-built nominal --no-pictures ";
  ASSERT_EQ(understudy(command + "--out " + (folder / "loose")).status, 0);
  const Outcome outcome = understudy(command + "--tip-tolerance 0.01 --out " + (folder / "tight"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("more than 0.01 mm"));
  EXPECT_THAT(outcome.out, HasSubstr("understudy calibrate"));
  const auto loose = nlohmann::json::parse(read_file(folder / "loose/summary.json"));
  const auto tight = nlohmann::json::parse(read_file(folder / "tight/summary.json"));
  EXPECT_EQ(loose["go"], true);
  EXPECT_EQ(loose["accuracy"]["tip_tolerance_mm"], 0.2);
  EXPECT_EQ(tight["grade"], "no-go");
  EXPECT_EQ(tight["findings"][0]["kind"], "accuracy");
  EXPECT_EQ(tight["findings"][0]["limit"], 0.01);
}

TEST(Rehearse, PrintingInTheAirIsANoGo) {
  const Folder folder;
  const auto file =
      folder.write("air.gcode", "G21\nG90\nM82\nM109 S230\nG0 X0 Y0 Z60 W1 I0 J0 K0\nG1 X5 E0.2 F300\n");
  const Outcome outcome = understudy("rehearse " + file + " --no-pictures --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const auto summary = nlohmann::json::parse(read_file(folder / "out/summary.json"));
  ASSERT_FALSE(summary["findings"].empty());
  EXPECT_EQ(summary["findings"][0]["kind"], "adhesion");
  EXPECT_EQ(summary["findings"][0]["gcode_line"], 6);
  EXPECT_FALSE(summary.contains("gap")) << "there is no gap where nothing lies below";
}

TEST(Rehearse, ALineBesideTheTableIsANoGo) {
  const Folder folder;
  const auto file = folder.write(
      "beside.gcode", "M109 S230\nG0 X140 Y0 Z20 F3000\nG1 X140 Y0 Z0.16 F300\nG1 X140 Y20 E0.7 F600\n");
  for (const char* machine : {"arm", "five-axis"}) {
    const Outcome outcome = understudy("rehearse " + file + " --engine quasistatic --no-pictures --machine " +
                                       machine + " --out " + (folder / machine));
    EXPECT_EQ(outcome.status, 1) << machine << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("nothing lies below")) << machine;
  }
}

TEST(Rehearse, InterruptedLeavesNothing) {
  const Folder folder;
  int interrupted = 0;
  for (const double seconds : {0.3, 0.6, 0.9, 1.2, 2.4, 4.8}) {
    const Outcome outcome = understudy_interrupted(kBottle + "--out " + (folder / "out"), seconds);
    if (outcome.status <= 1) break;  // it was faster than the signal
    EXPECT_EQ(folder.entries(), 0) << seconds;
    if (outcome.err.empty()) continue;  // before main() could say what a signal means
    EXPECT_EQ(outcome.status, 128 + SIGINT) << seconds << " s: " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
    if (++interrupted == 3) break;
  }
  EXPECT_GT(interrupted, 0) << "no signal met the work";
}

TEST(Help, EveryCommandExplainsItself) {
  for (const char* words :
       {"--help", "rehearse --help", "scenario --help", "scenario run --help", "plan surface --help",
        "sweep --help", "axes --help", "poses --help", "export mjcf --help", "--version"}) {
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 0) << words;
    EXPECT_GT(outcome.out.size(), 10u) << words;
    EXPECT_EQ(outcome.err, "") << words;
  }
}

TEST(Rehearse, TheRecordKeepsTheVersionsOfTheLibraries) {
  const Folder folder;
  ASSERT_LE(understudy(kBottle + "--engine quasistatic --no-pictures --out " + (folder / "out")).status, 1);
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "out" / "summary.json"));
  const std::string doctor = understudy("doctor").out;
  const auto& libraries = summary["provenance"]["libraries"];
  for (const auto& [library, version] : libraries.items())
    EXPECT_THAT(doctor, testing::ContainsRegex("lib  " + library + " +" + version.get<std::string>()));
  // What reads the command line, packs, draws or serves a page and exports a result has no part in it.
  const std::set<std::string> without_part{"CLI11", "HDF5",     "cpp-httplib", "fflate",
                                           "three", "tinygltf", "uplot",       "zlib"};
  std::istringstream lines(doctor);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, library;
    if (words >> word >> library && word == "lib" && !without_part.contains(library)) {
      EXPECT_TRUE(libraries.contains(library)) << library;
    }
  }
}

TEST(Rehearse, APartAsPrintedMayLieAmongTheResults) {
  const Folder folder;
  const std::string command = kBottle + "--engine quasistatic --no-pictures --out " + (folder / "out");
  for (int run = 0; run < 2; ++run) {
    const Outcome outcome = understudy(command + " --as-printed " + (folder / "out/part.stl"));
    EXPECT_LE(outcome.status, 1) << outcome.err;
    EXPECT_TRUE(fs::exists(folder.path() / "out/part.stl"));
    EXPECT_THAT(read_file(folder.path() / "out/manifest.sha256"), HasSubstr("part.stl"));
    EXPECT_EQ(folder.entries(), 1);
  }
}

TEST(Rehearse, ASeedThatIsNoneAndAnEmptyFixtureAreRefused) {
  const Folder folder;
  for (const char* seed : {"-1", "18446744073709551616", "1.5", "0x10", "\"\""}) {
    const Outcome outcome = understudy(kBottle + "--seed " + seed + " --out " + (folder / "out"));
    EXPECT_EQ(outcome.status, 2) << seed;
    EXPECT_THAT(outcome.err, HasSubstr("a seed is a whole number")) << seed;
  }
  EXPECT_THAT(understudy(kBottle + "--fixture '' --out " + (folder / "out")).err, HasSubstr("--fixture"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Rehearse, TextOfAFileDoesNotRepaintTheTerminal) {
  const Folder folder;
  const auto file = folder.write("e.gcode", "G1 X\"\033[2J\033[31mx\"\n");
  const Outcome outcome = understudy("rehearse " + file + " --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("\\x1b[2J"));
  EXPECT_EQ(outcome.err.find('\033'), std::string::npos);
}

TEST(Rehearse, APipeThatNobodyWritesToIsLeftAtASignal) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const Outcome outcome =
      understudy_interrupted("rehearse " + (folder / "pipe") + " --out " + (folder / "out"), 2);
  EXPECT_EQ(outcome.status, 128 + SIGINT);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

TEST(Rehearse, AnAnswerThatCannotBeToldIsAFailure) {
  const auto status = [](const std::string& streams) {
    return WEXITSTATUS(std::system((UNDERSTUDY_PROGRAM " machines " + streams).c_str()));
  };
  EXPECT_EQ(status(">/dev/full 2>/dev/null"), 3);
  EXPECT_EQ(status(">/dev/full 2>&-"), 3) << "there is nobody to tell";
  EXPECT_EQ(status(">/dev/null 2>&-"), 0);
}

}  // namespace
}  // namespace understudy::cli_test
