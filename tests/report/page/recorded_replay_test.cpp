#include "report/page/recorded_replay.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "report/page/write_results.h"
#include "sim/surface/bead_sweep.h"
#include "tests/report/sample_record.h"
#include "tests/report/sample_replay.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class RecordedReplayTest : public testing::Test {
 protected:
  RecordedReplayTest() : record_(sample_go()) {
    add_sample_replay(record_);
    write_results(record_, {}, folder_);
  }
  std::string page() const { return read_file(folder_ / "report.html"); }
  void change(const std::string& from, const std::string& to) {
    std::string text = page();
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / "report.html", text.replace(at, from.size(), to));
  }
  std::string refusal() const {
    try {
      read_recorded_replay(folder_);
      return "none";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  rehearsal::Record record_;
  TemporaryFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

// A page rounds to a micrometre or six digits, 0.1 ms and 1e-5 of a quaternion.
TEST_F(RecordedReplayTest, BodiesAndTheirPosesComeBack) {
  const RecordedReplay replay = read_recorded_replay(folder_);
  const rehearsal::Replay& truth = *record_.replay;
  EXPECT_EQ(replay.title, record_.title);
  ASSERT_EQ(replay.machine.bodies.size(), truth.bodies.size());
  ASSERT_EQ(replay.machine.key_times.size(), truth.key_times.size());
  int struts = 0;
  for (std::size_t b = 0; b < truth.bodies.size(); ++b) {
    const auto &one = replay.machine.bodies[b], &other = truth.bodies[b];
    EXPECT_EQ(one.shape.name, other.shape.name);
    EXPECT_EQ(one.carrier, other.carrier);
    EXPECT_EQ(one.shape.form.index(), other.shape.form.index());
    if (other.carrier == rehearsal::ReplayBody::Carrier::strut) {
      ++struts;
      EXPECT_LT((one.from_W - other.from_W).norm(), 1e-6);
      EXPECT_LT((one.to_T - other.to_T).norm(), 1e-6);
    } else if (other.carrier != rehearsal::ReplayBody::Carrier::axes) {
      EXPECT_TRUE(one.shape.X_FS.isApprox(other.shape.X_FS, 1e-6)) << one.shape.name;
    }
  }
  EXPECT_EQ(struts, 6);
}

TEST_F(RecordedReplayTest, ThePathAndItsGapComeBack) {
  const RecordedReplay replay = read_recorded_replay(folder_);
  EXPECT_TRUE(std::isnan(replay.path.front().gap));
  std::size_t seen = 0;
  for (const auto& point : replay.path)
    for (const auto& truth : record_.trace) {
      if (std::abs(truth.time - point.time) > 5e-5) continue;
      ++seen;
      EXPECT_LT((truth.X_WT.translation() - point.X_WT.translation()).norm(), 1e-6);
      EXPECT_LT(angle_between(truth.X_WT.linear(), point.X_WT.linear()), 5e-5);
      if (std::isfinite(truth.gap)) {
        EXPECT_NEAR(truth.gap, point.gap, 0.06e-6);
      }
      EXPECT_EQ(truth.extruding, point.extruding);
    }
  EXPECT_EQ(seen, replay.path.size());
  ASSERT_TRUE(replay.path_within && replay.gap_band);
  EXPECT_DOUBLE_EQ(replay.gap_band->max, 1e-3 * record_.gap_accepted_max_mm);
}

TEST_F(RecordedReplayTest, BeadsComeBack) {
  const RecordedReplay replay = read_recorded_replay(folder_);
  const auto truth = sim::sweep_beads(record_.scene->printed->beads());
  ASSERT_EQ(replay.beads.size(), truth.size());
  EXPECT_DOUBLE_EQ(replay.beads_within, 2e-6);
  for (std::size_t s = 0; s < truth.size(); ++s) {
    ASSERT_EQ(replay.beads[s].size(), truth[s].size());
    for (std::size_t i = 0; i < truth[s].size(); ++i) {
      EXPECT_LT((replay.beads[s][i].middle_W - truth[s][i].middle_W).norm(), 1e-6);
      EXPECT_NEAR(replay.beads[s][i].width, truth[s][i].width, 0.51e-6);
      EXPECT_NEAR(replay.beads[s][i].laid_at, truth[s][i].laid_at, 0.51e-4);
    }
  }
}

TEST_F(RecordedReplayTest, WhatIsMissingIsTold) {
  record_.findings.push_back({});
  record_.findings.back().message = "the print stopped: the nozzle is clogged";
  write_results(record_, {}, folder_);
  const RecordedReplay replay = read_recorded_replay(folder_);
  ASSERT_EQ(replay.shortfalls.size(), 1u);
  EXPECT_THAT(replay.shortfalls[0],
              HasSubstr("of a part of the print: the print stopped: the nozzle is clogged"));
}

TEST_F(RecordedReplayTest, WhatIsNoRecordIsRefusedInOneLine) {
  EXPECT_EQ(refusal(), "none");
  change("understudy.report/1", "understudy.report/2");
  EXPECT_THAT(refusal(), HasSubstr("report.html: its data is of version \"understudy.report/2\", and this"));
  change("understudy.report/2", "understudy.report/1");
  change("\"path\":", "\"pfad\":");
  EXPECT_THAT(refusal(), EndsWith("report.html: its data block is damaged: key 'path' not found"));
  change("\"pfad\":", "\"path\":");
  change("\"replay\":", "\"replays\":");
  EXPECT_THAT(refusal(),
              HasSubstr("it has no replay: rehearse a program that runs, and without --no-pictures"));
  const std::string whole = page();
  write_file(folder_ / "report.html", whole.substr(0, whole.find("id=\"record\"") + 2000));
  EXPECT_THAT(refusal(), HasSubstr("it is cut short: its data block does not end"));
  write_file(folder_ / "report.html", "<html></html>");
  EXPECT_THAT(refusal(),
              HasSubstr("it has no data of a rehearsal: name a folder that understudy rehearse wrote"));
  std::filesystem::remove(folder_ / "report.html");
  EXPECT_THAT(refusal(),
              EndsWith("report.html: it is not there: name a folder that understudy rehearse wrote"));
}

// A column that lost its end, or a letter, is not read as a shorter one.
TEST_F(RecordedReplayTest, DamagedColumnsAreRefused) {
  const std::string whole = page();
  const std::size_t curves = whole.find("\"over_time\":");  // these are for the page alone
  std::size_t after = curves, refused = 0, tried = 0;
  if (curves != std::string::npos) {
    int open = 0;
    do {
      after = whole.find_first_of("{}", after + 1);
      open += whole[after] == '{' ? 1 : -1;
    } while (open > 0);
  }
  for (std::size_t at = whole.find("\"data\":\""); at != std::string::npos;
       at = whole.find("\"data\":\"", at + 1)) {
    if ((at > curves && at < after) || ++tried % 7 != 0) continue;
    std::string cut = whole;
    cut.erase(at + 12, 9);
    write_file(folder_ / "report.html", cut);
    EXPECT_THAT(refusal(), HasSubstr("report.html: "));
    ++refused;
  }
  EXPECT_GT(refused, 2u);
}

}  // namespace
}  // namespace understudy::report
