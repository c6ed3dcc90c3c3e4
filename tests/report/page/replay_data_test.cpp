#include "report/page/replay_data.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/page/pack.h"
#include "tests/report/page/unpack.h"
#include "tests/report/sample_record.h"
#include "tests/report/sample_replay.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using rehearsal::Record;

std::vector<double> values(const Json& column) {
  const double unit = column.at("unit");
  std::vector<double> numbers;
  for (const std::int64_t n : integers(column.at("data")))
    numbers.push_back(n == kNone ? std::nan("") : static_cast<double>(n) * unit);
  return numbers;
}

Record sample() {
  Record record = sample_go();
  add_sample_replay(record);
  return record;
}

TEST(ReplayData, ARecordWithoutReplayHasNone) {
  EXPECT_TRUE(replay_data(sample_go()).is_null());
  EXPECT_TRUE(replay_data(sample_stopped_by_constraints()).is_null());
}

// Straight lines between the kept instants stand for all of the trace: its own words, held against the trace.
TEST(ReplayData, ThePathIsWithinWhatItStates) {
  const Record record = sample();
  const Json path = replay_data(record).at("path");
  const double within_mm = 1e-3 * path.at("within_um").get<double>() + 1e-3;  // and the rounding
  const auto times = values(path.at("time_s")), x = values(path.at("tool").at("x_mm")),
             z = values(path.at("tool").at("z_mm"));
  ASSERT_EQ(times.size(), path.at("points").get<std::size_t>());
  ASSERT_LT(times.size(), record.trace.size());
  std::size_t k = 0;
  for (const auto& point : record.trace) {
    while (k + 2 < times.size() && times[k + 1] <= point.time) ++k;
    const double share = (point.time - times[k]) / (times[k + 1] - times[k]);
    EXPECT_NEAR(x[k] + share * (x[k + 1] - x[k]), 1e3 * point.X_WT.translation().x(), within_mm)
        << point.time;
    EXPECT_NEAR(z[k] + share * (z[k + 1] - z[k]), 1e3 * point.X_WT.translation().z(), within_mm)
        << point.time;
  }
}

TEST(ReplayData, WhatIsNotBelowIsMissing) {
  const Json path = replay_data(sample()).at("path");
  EXPECT_TRUE(std::isnan(values(path.at("gap_um")).front()));
}

TEST(ReplayData, SectionsAddUpAndCarryTheBeadsWidths) {
  const Record record = sample();
  const Json beads = replay_data(record).at("beads");
  EXPECT_EQ(beads.at("beads"), record.scene->printed->beads().size());
  EXPECT_EQ(beads.at("within_um"), 2.0);
  const auto stretches = integers(beads.at("stretches"));
  const auto sections =
      static_cast<std::size_t>(std::accumulate(stretches.begin(), stretches.end(), std::int64_t{0}));
  for (const char* column : {"x_mm", "up_z", "width_mm", "height_mm", "time_s"})
    EXPECT_EQ(values(beads.at(column)).size(), sections) << column;
  for (const double width : values(beads.at("width_mm"))) EXPECT_NEAR(width, 0.48, 0.031);
  EXPECT_EQ(beads.at("type_names"), (Json{"", "Perimeter", "Infill"}));
}

TEST(ReplayData, BeyondTheBudgetItIsCoarserAndSaysSo) {
  const Record record = sample();
  ReplayBudget tight;
  tight.sections = 1;
  tight.points = 4;
  tight.program_bytes = 500;
  const Json data = replay_data(record, tight);
  EXPECT_GT(data.at("beads").at("within_um"), 2.0);
  EXPECT_GE(data.at("beads").value("one_stretch_of", 0), 2);
  EXPECT_FALSE(data.at("path").contains("within_um"));
  EXPECT_EQ(data.at("path").at("points"), 4);
  const std::string text = unpacked(data.at("program").at("text"));
  EXPECT_LE(text.size(), 500u);
  EXPECT_EQ(text.size() + data.at("program").at("left_out_bytes").get<std::size_t>(),
            record.replay->program.size());
}

TEST(ReplayData, AProgramThatWasNotKeptWholeCountsWhatIsBehind) {
  Record record = sample();
  EXPECT_FALSE(replay_data(record).at("program").contains("left_out_bytes"));
  record.replay->program_left_out = 123;
  const Json program = replay_data(record).at("program");
  EXPECT_EQ(program.at("left_out_bytes"), 123);
  EXPECT_EQ(unpacked(program.at("text")), record.replay->program);
}

TEST(ReplayData, AMeshBeyondTheBudgetIsItsBox) {
  Record record = sample();
  std::vector<Vec3> corners{{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 2e-3}};
  const auto mesh = std::make_shared<geometry::Mesh>(
      corners, std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  record.replay->bodies = {
      {{"bracket", geometry::MeshShape{mesh}}, rehearsal::ReplayBody::Carrier::world, {}, {}, {}}};
  EXPECT_TRUE(replay_data(record).at("bodies").at(0).at("form").contains("mesh"));
  ReplayBudget tight;
  tight.triangles = 3;
  const Json form = replay_data(record, tight).at("bodies").at(0).at("form");
  EXPECT_EQ(form.at("box_for_triangles"), 4);
  EXPECT_EQ(form.at("box_mm"), (Json{1.0, 1.0, 2.0}));
}

}  // namespace
}  // namespace understudy::report
