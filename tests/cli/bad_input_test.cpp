#include <algorithm>
#include <fstream>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kBottleLine = kSource + "/scenarios/song-bottle.gcode";

/// Bad input: exit status 2, one line that holds each of `parts`, nothing on stdout, nothing written.
void expect_refused(const std::string& words, const Folder& folder, const std::vector<std::string>& parts) {
  const int before = folder.entries();
  const Outcome outcome = understudy(words);
  EXPECT_EQ(outcome.status, 2) << words << "\n" << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  for (const auto& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_EQ(folder.entries(), before) << "something was written";
}

class BadProgram : public ::testing::Test {
 protected:
  void expect_program_refused(const std::string& text, const std::vector<std::string>& parts,
                              const std::string& options = "") {
    const std::string file = folder_.write("bad.gcode", text);
    expect_refused("rehearse " + file + " --out " + (folder_ / "out") + options, folder_, parts);
  }
  Folder folder_;
};

TEST_F(BadProgram, EmptyFile) { expect_program_refused("", {"bad.gcode"}); }

TEST_F(BadProgram, UnknownWordNamesLineAndColumn) {
  expect_program_refused("G21\nG90\nG1 X1 Q5 F300\n", {"bad.gcode:3:7", "Q"}, " --strict");
}

TEST_F(BadProgram, QuaternionThatIsNotUnit) {
  expect_program_refused("G21\nG1 X0 Y0 Z50 W0.9 I0.1 J0 K0 F300\n", {"bad.gcode:2", "0.9"});
}

TEST_F(BadProgram, MissingFeed) {
  expect_program_refused("G21\nG1 X1\n", {"bad.gcode:2", "feed"}, " --strict");
}

TEST_F(BadProgram, NotANumber) {
  expect_program_refused("G21\nG1 Xnan F300\n", {"bad.gcode:2"});
  expect_program_refused("G21\nG1 Xinf F300\n", {"bad.gcode:2"});
  expect_program_refused("G21\nG1 X1.2.3 F300\n", {"bad.gcode:2"});
}

TEST_F(BadProgram, MissingFile) {
  expect_refused("rehearse " + (folder_ / "none.gcode") + " --out " + (folder_ / "out"), folder_,
                 {"none.gcode"});
}

class BadFixture : public ::testing::Test {
 protected:
  void expect_fixture_refused(const std::string& file, const std::vector<std::string>& parts) {
    expect_refused("rehearse " + kBottleLine + " --fixture " + file + " --out " + (folder_ / "out"), folder_,
                   parts);
  }
  std::string bottle() const { return read_file(kSource + "/models/parts/bottle.stl"); }
  Folder folder_;
};

TEST_F(BadFixture, Truncated) {
  expect_fixture_refused(folder_.write("cut.stl", bottle().substr(0, 1000)), {"cut.stl"});
}

TEST_F(BadFixture, Open) {
  std::string stl = bottle();
  const auto triangles = static_cast<unsigned char>(stl[80]) | static_cast<unsigned char>(stl[81]) << 8 |
                         static_cast<unsigned char>(stl[82]) << 16;
  const auto fewer = triangles - 1;
  stl[80] = static_cast<char>(fewer & 255);
  stl[81] = static_cast<char>((fewer >> 8) & 255);
  stl[82] = static_cast<char>((fewer >> 16) & 255);
  stl.resize(stl.size() - 50);
  expect_fixture_refused(folder_.write("open.stl", stl),
                         {"open.stl", "3"});  // a missing triangle leaves 3 edges
}

TEST_F(BadFixture, InMetres) {
  std::string stl = bottle();
  for (std::size_t at = 84; at + 50 <= stl.size(); at += 50) {
    for (std::size_t k = 12; k < 48; k += 4) {
      float v;
      std::copy_n(&stl[at + k], 4, reinterpret_cast<char*>(&v));
      v *= 1e-3f;
      std::copy_n(reinterpret_cast<char*>(&v), 4, &stl[at + k]);
    }
  }
  expect_fixture_refused(folder_.write("metres.stl", stl), {"metres.stl", "mm"});
}

TEST_F(BadFixture, UnknownNameListsTheKnown) { expect_fixture_refused("botle", {"botle", "bottle"}); }

TEST(BadMachine, MisspeltKeyNamesTheNearest) {
  const Folder folder;
  std::string yaml = read_file(kSource + "/models/hexapod/machine.yaml");
  const auto at = yaml.find("lead_mm");
  ASSERT_NE(at, std::string::npos);
  yaml.replace(at, 7, "leed_mm");
  const std::string file = folder.write("machine.yaml", yaml);
  expect_refused("rehearse " + kBottleLine + " --machine " + file + " --out " + (folder / "out"), folder,
                 {"machine.yaml:", "leed_mm", "lead_mm"});
}

TEST(BadMachine, UnknownNameListsTheKnown) {
  const Folder folder;
  expect_refused("rehearse " + kBottleLine + " --machine hexapode --out " + (folder / "out"), folder,
                 {"hexapode", "hexapod"});
}

/// The truth of one machine is none of another.
TEST(BadAsBuilt, AFileOfAnotherMachineIsNamed) {
  const Folder folder;
  const std::string rest = " --fixture bottle --out " + (folder / "out") + " --as-built ";
  const std::string named = folder.write("named.yaml", "machine: delta\ndeviation_mm: 15\n");
  expect_refused("rehearse " + kBottleLine + rest + named, folder, {"named.yaml:1", "delta", "hexapod"});
  const std::string chain = folder.write("chain.yaml", "tip_mm: [0, 0, 0]\n");
  expect_refused("rehearse " + kBottleLine + rest + chain, folder, {"chain.yaml:1", "tip_mm"});
}

TEST(BadFixtureFile, ANegativeToleranceOrAnotherUnitIsNamedWithItsLine) {
  const Folder folder;
  const std::string rest = " --out " + (folder / "out") + " --fixture ";
  const auto clamp = [&](const std::string& tolerance) {
    return folder.write("clamp.yaml", "shape: bottle\ntolerances:\n  " + tolerance + "\n");
  };
  const std::string negative = clamp("position_mm: -0.2");
  expect_refused("rehearse " + kBottleLine + rest + negative, folder,
                 {"clamp.yaml:3", "position_mm", "-0.2"});
  const std::string unit = clamp("position_um: 200");
  expect_refused("rehearse " + kBottleLine + rest + unit, folder,
                 {"clamp.yaml:3", "position_um", "position_mm"});
}

TEST(BadUsage, OneLineAndStatusTwo) {
  const Folder folder;
  expect_refused("", folder, {"understudy"});
  expect_refused("rehears x", folder, {"rehears"});
  expect_refused("rehearse", folder, {"program"});
  const std::string rest = " --fixture bottle --out " + (folder / "out");
  expect_refused("rehearse " + kBottleLine + " --gap-control sometimes" + rest, folder,
                 {"sometimes", "off", "start"});
  expect_refused("rehearse " + kBottleLine + " --engine magic" + rest, folder, {"magic", "mujoco"});
  expect_refused("rehearse " + kBottleLine + " --as-built dreamt" + rest, folder, {"dreamt", "sampled"});
  expect_refused("rehearse " + kBottleLine + " --seed -1" + rest, folder, {"seed"});
}

TEST(BadUsage, AMisspeltSubCommandIsNamedWithTheNearest) {
  const Folder folder;
  expect_refused("rehears", folder, {"unknown command 'rehears'; did you mean 'rehearse'?"});
  expect_refused("plan spirral -o a.gcode", folder,
                 {"unknown command 'plan spirral'; did you mean 'plan spiral'?"});
  expect_refused("schema 7", folder, {"unknown command 'schema 7': see understudy schema --help"});
}

TEST(BadUsage, AnErrorNamesTheHelpOfItsSubCommand) {
  const Folder folder;
  expect_refused("", folder, {"(see understudy --help)"});
  expect_refused("plan", folder, {"(see understudy plan --help)"});
  expect_refused("plan surface bottle", folder,
                 {"--output is required (see understudy plan surface --help)"});
  expect_refused("machines --all", folder, {"--all (see understudy machines --help)"});
}

// A variable of a script that is not set.
TEST(BadUsage, AnEmptyWordIsNoNumber) {
  const Folder folder;
  const std::string out = " -o " + (folder / "a.gcode");
  expect_refused("plan surface bottle --svg-width ''" + out, folder,
                 {"--svg-width: an empty word is no number (see understudy plan surface --help)"});
  expect_refused("plan surface bottle --section 0 0 '' 0 1 0" + out, folder, {"--section: an empty word"});
  expect_refused("rehearse " + kBottleLine + " --seed ''", folder, {"--seed"});
}

// CLI11 finds `nan` within any range.
TEST(BadUsage, ANumberThatIsNotFiniteIsRefused) {
  const Folder folder;
  for (const std::string option : {"--spin", "--nozzle", "--tip-tolerance", "--max-time"})
    expect_refused("rehearse " + kBottleLine + " " + option + " nan --out " + (folder / "out"), folder,
                   {option + ": 'nan' is not finite (see understudy rehearse --help)"});
  expect_refused("plan surface bottle --section 0 0 inf 0 1 0 -o " + (folder / "a.gcode"), folder,
                 {"--section: 'inf' is not finite"});
}

TEST(BadUsage, ANameThatIsTooLongForAFileIsRefusedAsAnyOther) {
  const Folder folder;
  const std::string name(300, 'a'), out = " --out " + (folder / "out");
  for (const std::string option : {"--fixture ", "--as-built ", "--intended ", "--macros ", "--material "})
    expect_refused("rehearse " + kBottleLine + " " + option + name + out, folder, {name.substr(0, 50)});
  expect_refused("compare " + name + " " + name, folder, {name.substr(0, 50)});
  expect_refused("export glb " + name + " -o " + (folder / "a.glb"), folder, {name.substr(0, 50)});
  expect_refused("plan surface " + name + " -o " + (folder / "a.gcode"), folder, {name.substr(0, 50)});
}

TEST(BadUsage, JobsAreFrom1To1024) {
  const Folder folder;
  const std::string commands[] = {"sweep " + kSource + "/scenarios/song-bottle.yaml",
                                  "scenario run",
                                  "workspace",
                                  "benchmark gap",
                                  "benchmark calibration",
                                  "benchmark faults"};
  for (const std::string& command : commands)
    for (const std::string& jobs : {std::string("0"), std::string("1025")}) {
      const std::string out = command == "scenario run" ? "" : " --out " + (folder / "out");
      expect_refused(command + " -j " + jobs + out, folder, {"-j " + jobs + " is outside 1..1024"});
    }
}

TEST(BadBudget, WhatCannotBeSharedOutIsRefusedBeforeTheWork) {
  const Folder folder;
  const std::string bottle =
      "sweep " + kSource + "/scenarios/song-bottle.yaml --budget --out " + (folder / "out");
  expect_refused(bottle + " --samples 7", folder, {"--samples 7 is outside 8..100000"});
  expect_refused(bottle + " --as-built nominal", folder, {"nominal", "manufactured"});
  const std::string built = folder.write("built.yaml", "deviation_mm: 14.5\n");
  expect_refused(bottle + " --as-built " + built, folder, {"built.yaml", "one machine"});
  expect_refused(bottle + " --as-built calibrated", folder, {"calibration"});
  expect_refused(bottle + " -j 0", folder, {"-j 0 is outside 1..1024"});
}

TEST(BadOutput, AFolderThatCannotBeWrittenIsRefusedBeforeTheWork) {
  const Folder folder;
  const std::string file = folder.write("file", "x");
  expect_refused("rehearse " + kBottleLine + " --fixture bottle --out " + file + "/out", folder,
                 {"file/out"});
  expect_refused("rehearse " + kBottleLine + " --fixture bottle --out /proc/understudy", folder,
                 {"/proc/understudy"});
}

TEST(BadOutput, AFolderOfSomebodyElseIsNotReplaced) {
  const Folder folder;
  folder.write("letter.txt", "dear");
  expect_refused("rehearse " + kBottleLine + " --fixture bottle --out " + folder.path().string(), folder,
                 {"letter.txt"});
}

}  // namespace
}  // namespace understudy::cli_test
