// `drive --resume`: a print that was cut short at any moment goes on, with no bead laid twice and none left
// out.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "machine/record/record_reader.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

/// Layers of a square, 8 mm wide, with a retraction between them: slow, so that a setpoint at its end holds
/// little.
std::string square_layers(int layers) {
  std::string text = "G21\nG90\nM83\nM104 S210\nG0 X0 Y0 Z40\n";
  const double x[] = {4, 4, -4, -4}, y[] = {-4, 4, 4, -4};
  for (int layer = 0; layer < layers; ++layer) {
    const double z = 0.3 + 0.2 * layer;
    text += fmt::format("G0 X-4 Y-4 Z{:.3f}\nG0 X-4 Y-4 Z{:.3f}\n", z + 2, z);
    if (layer > 0) text += "G1 E0.8 F60\n";
    for (int side = 0; side < 4; ++side)
      text += fmt::format("G1 X{} Y{} Z{:.3f} E0.266 F1200\n", x[side], y[side], z);
    text += fmt::format("G1 E-0.8 F60\nG0 X-4 Y-4 Z{:.3f}\n", z + 2);
  }
  return text;
}

/// By line: filament fed into it [m] by what a machine executed, and where it was when it first and last fed.
struct Laid {
  std::map<int, double> fed;
  machine::AxisVector first{}, last{};
  int first_line = 0, last_line = 0;
  bool any = false;
};

/// Reads what was executed by the states alone, with the queue's rules of docs/machine-port.md.
void add_laid(const std::string& record, const std::vector<int>& beads, Laid& laid) {
  std::deque<machine::Setpoint> queued;
  machine::Setpoint before;
  std::uint64_t executed = 0;
  laid.any = false;
  machine::read_record(record, [&](const machine::RecordedEntry& entry) {
    const auto* submit = std::get_if<machine::RecordedSubmit>(&entry);
    if (submit && submit->answer == machine::Status::ok)
      queued.insert(queued.end(), submit->setpoints.begin(), submit->setpoints.end());
    const auto* state = std::get_if<machine::AxisState>(&entry);
    if (!state) return;
    for (; executed < state->executed && !queued.empty(); ++executed) {
      const machine::Setpoint now = queued.front();
      queued.pop_front();
      const double fed = now.filament - before.filament;
      if (fed > 0 && std::ranges::find(beads, now.line) != beads.end()) {
        laid.fed[now.line] += fed;
        if (!laid.any) {
          laid.first = before.position;
          laid.first_line = now.line;
        }
        laid.last = now.position;
        laid.last_line = now.line;
        laid.any = true;
      }
      before = now;
    }
  });
}

bool completed(const std::string& record) {
  bool found = false;
  if (std::filesystem::exists(record))
    machine::read_record(record, [&](const machine::RecordedEntry& entry) {
      const auto* note = std::get_if<machine::RecordedNote>(&entry);
      found = found || (note && note->text == "completed");
    });
  return found;
}

/// Lines that print, and what they feed [m], read from the text itself.
std::map<int, double> programmed(const std::string& text) {
  std::map<int, double> beads;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.starts_with("G1 X")) beads[number] = 1e-3 * std::stod(line.substr(line.find('E') + 1));
  return beads;
}

class DriveResume : public ::testing::Test {
 protected:
  void SetUp() override { write_layers(8); }
  void write_layers(int layers) {
    text_ = square_layers(layers);
    lines_.clear();
    program_ = own_.write("square.gcode", text_);
    for (const auto& [line, fed] : programmed(text_)) lines_.push_back(line);
  }
  std::string drive(const std::string& record) const {
    return "drive " + program_ + " --gap-control off --without-rehearsal --port loopback:// --record " +
           (own_ / record);
  }
  /// Everything is laid once: within the filament of two setpoints, a millisecond each, at every cut.
  void expect_laid_once(const std::vector<std::string>& records, const std::string& how) const {
    Laid laid;
    machine::AxisVector stopped{};
    int stopped_line = 0;
    for (const std::string& record : records) {
      add_laid(own_ / record, lines_, laid);
      if (!laid.any) continue;
      for (std::size_t i = 0; stopped_line == laid.first_line && i < 6; ++i)
        EXPECT_NEAR(laid.first[i], stopped[i], kJoint) << how << record;
      stopped = laid.last;
      stopped_line = laid.last_line;
    }
    for (const auto& [line, fed] : programmed(text_))
      EXPECT_NEAR(laid.fed[line], fed, kFilament) << how << " line " << line << read_file(own_ / "said");
  }

  // At 20 mm/s a setpoint is 20 um of path and 0.67 um of filament; two at a cut, and no strut is faster.
  static constexpr double kJoint = 4.5e-5, kFilament = 1.5e-6;
  Folder own_;
  std::string text_, program_;
  std::vector<int> lines_;
};

TEST_F(DriveResume, LaysEveryBeadOnceWhereverTheRecordIsCut) {
  const Outcome whole = understudy(drive("whole.record"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  own_.write("said", "");
  expect_laid_once({"whole.record"}, "uncut");
  const std::string bytes = read_file(own_ / "whole.record");
  int resumed = 0;
  for (int cut = 1; cut <= 9; ++cut) {
    const std::string first = fmt::format("cut{}.record", cut), rest = fmt::format("rest{}.record", cut);
    // SIGKILL in the middle of an entry.
    own_.write(first, bytes.substr(0, bytes.size() * (static_cast<std::size_t>(cut) + 2) / 12 + 7));
    const Outcome outcome = understudy(drive(rest) + " --resume " + (own_ / first));
    if (outcome.err.find("before the first bead") != std::string::npos) {
      Laid none;
      add_laid(own_ / first, lines_, none);
      EXPECT_FALSE(none.any) << cut;
      continue;
    }
    ASSERT_EQ(outcome.status, 0) << cut << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("resumes"));
    own_.write("said", outcome.out);
    expect_laid_once({first, rest}, fmt::format("cut {} ", cut));
    ++resumed;
  }
  EXPECT_GE(resumed, 8);
}

TEST_F(DriveResume, GoesOnAfterCtrlCAndAfterAKillOneAfterTheOther) {
  write_layers(60);
  std::vector<std::string> records;
  int stops = 0;
  const auto file = [](int i) { return fmt::format("part{}.record", i); };
  bool done = false;
  for (int i = 0; i < 30 && !done; ++i) {
    std::string words = drive(file(i));
    if (!records.empty()) words += " --resume " + (own_ / records.back());
    // The loopback machine runs ahead of the wall clock: the whole print takes about a second, and longer
    // where the processors are busy. Each part gets a fifth more time than the one before.
    const char* signal = i % 2 == 0 ? "INT" : "KILL";
    const int status =
        std::system(fmt::format("timeout -s {} {} {} {} >{} 2>&1", signal, 0.15 * std::pow(1.2, i),
                                UNDERSTUDY_PROGRAM, words, own_ / "out")
                        .c_str());
    done = status == 0 || completed(own_ / file(i));
    if (!done && !std::filesystem::exists(own_ / file(i))) continue;
    if (!done) ++stops;
    Laid laid;
    add_laid(own_ / file(i), lines_, laid);
    if (laid.any || !records.empty())
      records.push_back(file(i));
    else if (!done)
      continue;  // cut before the first bead: from the beginning
  }
  ASSERT_TRUE(done) << read_file(own_ / "out");
  EXPECT_GE(stops, 2);
  expect_laid_once(records, fmt::format("{} stops ", stops));
}

TEST_F(DriveResume, RefusesWhatIsAnotherPrintOrHasNothingLeft) {
  ASSERT_EQ(understudy(drive("whole.record")).status, 0);
  const std::string bytes = read_file(own_ / "whole.record");
  own_.write("half.record", bytes.substr(0, bytes.size() / 2));
  own_.write("early.record", bytes.substr(0, bytes.size() / 400));
  const auto refused = [&](const std::string& words, const std::string& why) {
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 2) << words << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << words;
    EXPECT_FALSE(std::filesystem::exists(own_ / "new.record")) << words;
  };
  const std::string with = " --resume " + (own_ / "half.record");
  refused(drive("new.record") + " --resume " + (own_ / "whole.record"), "its print is complete");
  refused(drive("new.record") + " --resume " + (own_ / "early.record"), "before the first bead");
  refused(drive("new.record") + " --resume " + program_, "it is no record of a port");
  refused(drive("new.record") + with + " --fixture bottle", "another --fixture");
  refused(drive("new.record") + with + " --place 0,0,1", "another --place");
  refused(drive("new.record") + with + " --machine arm", "another machine file");
  own_.write("square.gcode", text_ + "; more\n");
  refused(drive("new.record") + with, "another program");
}

}  // namespace
}  // namespace understudy::cli_test
