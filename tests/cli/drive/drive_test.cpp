// `drive` and `post`: what is printed, what is refused, and what is recorded.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "machine/record/record_reader.h"
#include "tests/cli/drive/same_bits.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kBottle = kSource + "/scenarios/song-bottle.gcode --fixture bottle --gap-control off ";

/// The setpoints that a port took, in order, and the last note.
struct Recorded {
  std::vector<machine::Setpoint> setpoints;
  std::string last_note;
};

Recorded read(const std::string& file) {
  Recorded recorded;
  machine::read_record(file, [&](const machine::RecordedEntry& entry) {
    if (const auto* note = std::get_if<machine::RecordedNote>(&entry)) recorded.last_note = note->text;
    const auto* submit = std::get_if<machine::RecordedSubmit>(&entry);
    if (submit && submit->answer == machine::Status::ok)
      recorded.setpoints.insert(recorded.setpoints.end(), submit->setpoints.begin(), submit->setpoints.end());
  });
  return recorded;
}

/// One rehearsal for all tests, of a machine that keeps to the gap by itself: its folder, and the record of
/// the twin's port.
class Drive : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    rehearsed_ = understudy("rehearse " + kBottle + "--seed 6 --engine quasistatic --no-pictures --record " +
                            (*folder_ / "twin.record") + " --out " + (*folder_ / "go"));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(rehearsed_.status, 0) << rehearsed_.err << rehearsed_.out; }
  static std::string rehearsal() { return *folder_ / "go"; }

  Folder own_;
  static inline Folder* folder_ = nullptr;
  static inline Outcome rehearsed_;
};

TEST_F(Drive, GivesTheMachineTheVerySetpointsThatWereRehearsed) {
  // The quasistatic twin's clock runs in steps of 2 ms.
  const Outcome driven = understudy("drive " + kSource +
                                    "/scenarios/song-bottle.gcode --port loopback://?clock_ms=2"
                                    " --rehearsal " +
                                    rehearsal() + " --record " + (own_ / "drive.record"));
  ASSERT_EQ(driven.status, 0) << driven.err;
  EXPECT_THAT(driven.out, HasSubstr("printed"));
  const Recorded twin = read(*folder_ / "twin.record"), drive = read(own_ / "drive.record");
  EXPECT_EQ(drive.last_note, "completed");
  ASSERT_GT(twin.setpoints.size(), 5000U) << "some 5 s of motion, a setpoint a millisecond";
  ASSERT_EQ(twin.setpoints.size(), drive.setpoints.size());
  for (std::size_t i = 0; i < twin.setpoints.size(); ++i)
    ASSERT_TRUE(same_bits(twin.setpoints[i], drive.setpoints[i])) << i << " at " << twin.setpoints[i].time;
}

TEST_F(Drive, RefusesWhatWasNotRehearsed) {
  const std::string port = " --port loopback:// --record " + (own_ / "d.record");
  const std::string bottle = "drive " + kSource + "/scenarios/song-bottle.gcode";
  const auto refused = [&](const std::string& words, const std::string& why) {
    const Outcome outcome = understudy(words + port);
    EXPECT_EQ(outcome.status, 2) << words << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << words;
    EXPECT_FALSE(std::filesystem::exists(own_ / "d.record")) << words;
  };
  const std::string with = " --rehearsal " + rehearsal();
  refused(bottle, "nothing is printed that was not rehearsed");
  refused(bottle + " --rehearsal " + own_.path().string(), "summary.json");
  refused(bottle + with + " --gap-control start", "another --gap-control");
  refused(bottle + with + " --place 0,0,1", "another --place");
  refused(bottle + with + " --fixture crown", "--fixture");
  refused(bottle + with + " --machine arm", "another machine file");
  const std::string changed =
      own_.write("changed.gcode", read_file(kSource + "/scenarios/song-bottle.gcode") + "; more\n");
  refused("drive " + changed + with, "another program");
  refused(bottle + with + " --without-rehearsal", "excludes");
}

TEST_F(Drive, ANoGoIsNotPrinted) {
  const std::string program =
      own_.write("far.gcode", "G21\nG90\nM104 S230\nG0 X0 Y0 Z60\nG1 X95 Y95 Z1 F1200\n");
  const Outcome rehearsed = understudy(
      "rehearse " + program + " --engine quasistatic --no-pictures --gap-control off --out " + (own_ / "no"));
  ASSERT_EQ(rehearsed.status, 1) << rehearsed.err;
  const Outcome outcome = understudy("drive " + program + " --port loopback:// --rehearsal " + (own_ / "no") +
                                     " --record " + (own_ / "d.record"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the rehearsal says no-go"));
}

TEST(DriveWithoutRehearsal, ChecksTheMachineBeforeItMoves) {
  const Folder folder;
  const std::string program =
      folder.write("far.gcode", "G21\nG90\nM104 S230\nG0 X0 Y0 Z60\nG1 X95 Y95 Z1 F1200\n");
  const Outcome outcome =
      understudy("drive " + program + " --gap-control off --without-rehearsal --port loopback:// --record " +
                 (folder / "d.record"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("nothing has moved: limits: line 5"));
  EXPECT_THAT(outcome.out, HasSubstr("position  good"));
  EXPECT_THAT(read(folder / "d.record").last_note, HasSubstr("stopped before anything moved"));
}

TEST(DriveWithoutRehearsal, WritesOverNoRecordAndNamesWhatNobodyAnswers) {
  const Folder folder;
  const std::string program =
      kSource + "/scenarios/song-bottle.gcode --gap-control off --without-rehearsal --record ";
  const std::string record = folder.write("mine.record", "mine");
  const Outcome taken = understudy("drive " + program + record + " --port loopback://");
  EXPECT_EQ(taken.status, 2);
  EXPECT_THAT(taken.err, HasSubstr("it is there already"));
  EXPECT_EQ(read_file(record), "mine");
  const Outcome nobody =
      understudy("drive " + program + (folder / "a") + " --port tcp://127.0.0.1:1?family=marlin");
  EXPECT_EQ(nobody.status, 3);
  EXPECT_THAT(nobody.err, HasSubstr("nobody answers"));
  const Outcome none =
      understudy("drive " + program + (folder / "a") + " --port serial:///dev/null?family=marlin");
  EXPECT_GE(none.status, 2);
  const Outcome word = understudy("drive " + program + (folder / "a") + " --port carrier-pigeon://");
  EXPECT_EQ(word.status, 2);
  EXPECT_THAT(word.err, HasSubstr("unknown kind of port"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

TEST(Post, WritesAProgramForEachFamilyAndRefusesGapControl) {
  const Folder folder;
  for (const char* family : {"grblhal", "marlin", "reprapfirmware"}) {
    const Outcome outcome = understudy("post " + kSource + "/scenarios/song-bottle.gcode --for " + family +
                                       " -o " + (folder / "out.gcode"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("blocks/s"));
    EXPECT_THAT(read_file(folder / "out.gcode"), HasSubstr("G1 "));
  }
  EXPECT_EQ(
      understudy("post " + kSource + "/scenarios/song-bottle.gcode --for marlyn -o " + (folder / "x")).status,
      2);
  const Outcome eyes =
      understudy("post " + kSource + "/scenarios/song-bottle.gcode --gap-control start --for marlin -o " +
                 (folder / "x"));
  EXPECT_EQ(eyes.status, 2);
  EXPECT_THAT(eyes.err, HasSubstr("no camera"));
  EXPECT_FALSE(std::filesystem::exists(folder / "x"));
}

}  // namespace
}  // namespace understudy::cli_test
