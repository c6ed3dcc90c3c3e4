#include "machine/record/recording_port.h"

#include <array>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "machine/loopback_port.h"
#include "machine/record/record_reader.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

constexpr double kNever = 1e9;

std::vector<Setpoint> two_setpoints() {
  std::vector<Setpoint> two(2);
  two[0].time = 0.1 + 1e-17;
  two[1].time = 1.0 / 3;
  two[0].position = two[1].position = {0.1, -1.0 / 7, 1e-300};
  two[0].velocity = {-0.0, 2, 3};
  two[1].filament = 0.25;
  two[1].line = 1187;
  return two;
}

/// Everything once, on a port with three axes.
void use(const std::filesystem::path& file) {
  LoopbackPort::Options options;
  options.axis_count = 3;
  LoopbackPort port(options, [](const AxisState&, const Region& region, Image& image) {
    image = {region, {1, 2, 3, 4, 5, 255}};
    return true;
  });
  RecordWriter writer(file, 3);
  RecordingPort recorded(port, writer);
  writer.note("program_sha256 abc");
  ASSERT_EQ(recorded.submit(two_setpoints(), kNever), Status::ok);
  ASSERT_EQ(recorded.submit(two_setpoints(), kNever), Status::rejected);
  ASSERT_EQ(recorded.wait_until(0.015), Status::ok);
  ASSERT_EQ(recorded.urgent(UrgentCommand::hold), Status::ok);
  ASSERT_EQ(recorded.set_outputs({483, 0.5}, kNever), Status::ok);
  Frame frame;
  ASSERT_EQ(recorded.capture({1, 2, 3, 2}, frame, kNever), Status::ok);
}

std::vector<RecordedEntry> entries_of(const std::filesystem::path& file, RecordEnd* end = nullptr) {
  std::vector<RecordedEntry> entries;
  const RecordEnd read = read_record(file, [&](const RecordedEntry& entry) { entries.push_back(entry); });
  if (end) *end = read;
  return entries;
}

TEST(RecordingPort, WritesEverythingThatGoesThroughToTheLastBit) {
  const TemporaryFolder folder;
  use(folder / "a.record");
  RecordEnd end;
  const auto entries = entries_of(folder / "a.record", &end);
  EXPECT_TRUE(end.whole);
  EXPECT_EQ(end.axes, 3);
  // A note, two submits, two parts of a wait with a state each, a hold, outputs, a frame with a state.
  ASSERT_EQ(entries.size(), 11U);
  EXPECT_EQ(std::get<RecordedNote>(entries[0]).text, "program_sha256 abc");
  const auto& submit = std::get<RecordedSubmit>(entries[1]);
  EXPECT_EQ(submit.answer, Status::ok);
  ASSERT_EQ(submit.setpoints.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Setpoint &read = submit.setpoints[i], put = two_setpoints()[i];
    EXPECT_EQ(read.time, put.time);
    EXPECT_EQ(read.position, put.position);
    EXPECT_EQ(read.velocity, put.velocity);
    EXPECT_EQ(read.filament, put.filament);
    EXPECT_EQ(read.line, put.line);
  }
  EXPECT_EQ(std::get<RecordedSubmit>(entries[2]).answer, Status::rejected);
  EXPECT_EQ(std::get<RecordedWait>(entries[5]).ended, 0.015);
  EXPECT_EQ(std::get<AxisState>(entries[6]).accepted, 2U);
  EXPECT_EQ(std::get<RecordedUrgent>(entries[7]).command, UrgentCommand::hold);
  EXPECT_EQ(std::get<RecordedOutputs>(entries[8]).outputs.nozzle_temperature, 483);
  const auto& frame = std::get<RecordedFrame>(entries[9]);
  EXPECT_EQ(frame.frame.image.region, (Region{1, 2, 3, 2}));
  EXPECT_THAT(frame.frame.image.pixels, testing::ElementsAre(1, 2, 3, 4, 5, 255));
}

TEST(RecordingPort, ARecordThatIsCutAnywhereIsReadToItsLastWholeEntry) {
  const TemporaryFolder folder;
  use(folder / "a.record");
  const std::string bytes = read_file(folder / "a.record");
  const std::size_t all = entries_of(folder / "a.record").size();
  const std::size_t first_line = bytes.find('\n') + 1;
  std::size_t before = 0;
  for (std::size_t cut = first_line; cut <= bytes.size(); ++cut) {
    std::ofstream(folder / "cut.record", std::ios::binary) << bytes.substr(0, cut);
    RecordEnd end;
    const std::size_t count = entries_of(folder / "cut.record", &end).size();
    ASSERT_GE(count, before);
    ASSERT_LE(count, before + 1);
    ASSERT_EQ(end.whole, end.size == cut) << cut;
    before = count;
  }
  EXPECT_EQ(before, all);
}

TEST(RecordingPort, AByteThatIsWrongEndsTheRecordBeforeItsEntry) {
  const TemporaryFolder folder;
  use(folder / "a.record");
  std::string bytes = read_file(folder / "a.record");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  std::ofstream(folder / "wrong.record", std::ios::binary) << bytes;
  RecordEnd end;
  EXPECT_LT(entries_of(folder / "wrong.record", &end).size(), 11U);
  EXPECT_FALSE(end.whole);
}

TEST(RecordingPort, WritesOverNothingAndReadsNothingElse) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mine.txt") << "my thesis\n";
  EXPECT_THROW(RecordWriter(folder / "mine.txt", 6), InputError);
  EXPECT_EQ(read_file(folder / "mine.txt"), "my thesis\n");
  EXPECT_THROW(entries_of(folder / "mine.txt"), InputError);
  EXPECT_THROW(entries_of(folder / "none"), InputError);
  EXPECT_THROW(RecordWriter(folder / "no folder" / "a.record", 6), InputError);
}

TEST(RecordingPort, PythonReadsARecordWithoutUs) {
  const TemporaryFolder folder;
  use(folder / "a.record");
  const std::string command = std::string("python3 " UNDERSTUDY_SOURCE_DIR "/examples/read_record.py '") +
                              (folder / "a.record").string() + "' > '" + (folder / "out").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string said = read_file(folder / "out");
  EXPECT_THAT(said, testing::HasSubstr(
                        "note program_sha256 abc\nsubmit 0.0 ok 2\n  setpoint 0.10000000000000002 0 0.1 "));
  EXPECT_THAT(said,
              testing::HasSubstr("setpoint 0.3333333333333333 1187 0.1 -0.14285714285714285 1e-300 0.25"));
  EXPECT_THAT(said, testing::HasSubstr("executed 0 of 2"));
}

}  // namespace
}  // namespace understudy::machine
