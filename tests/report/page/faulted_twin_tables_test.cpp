#include "report/page/faulted_twin_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace understudy::report {
namespace {

using studies::FaultedTrial;
using studies::FaultedTwin;
using studies::Judgement;
using testing::HasSubstr;

FaultedTrial trial(int number, const char* fault, const char* answer, Judgement judgement) {
  FaultedTrial t;
  t.number = number;
  t.world = 7;
  t.surface = "flat";
  t.fault = fault;
  t.words = std::string("camera ") + fault;
  t.answer = answer;
  t.judgement = judgement;
  t.least_gap = 50e-6;
  t.last_gap = 130e-6;
  return t;
}

FaultedTwin three_trials() {
  FaultedTwin twin;
  twin.worlds = 3;
  twin.unsound.push_back({5, "flat", "too close"});
  twin.plants.resize(2);
  twin.plants[0].trials = {trial(0, "none", "reached", Judgement::right),
                           trial(1, "dark", "no dot", Judgement::right),
                           trial(2, "dark", "too far", Judgement::wrong_reason)};
  twin.plants[1] = twin.plants[0];
  twin.plants[1].plant = {"mujoco", 0.1e-3};
  twin.plants[1].difference = {1, 1e-6, 2e-6, 3e-6};
  return twin;
}

TEST(FaultedTwinTables, TheConfusionTableMarksWhatIsWrong) {
  const auto tables = faulted_twin_tables(three_trials());
  ASSERT_EQ(tables.size(), 4u);
  const std::string confusion = plain_text(tables[0]);
  EXPECT_THAT(confusion, HasSubstr("fault  trials  not in play  reached  no dot      too far\n"));
  EXPECT_THAT(confusion, HasSubstr("dark        2            0                1  1 (1 wrong)\n"));
  EXPECT_THAT(plain_text(tables[1]), HasSubstr("wrong reason"));
  EXPECT_EQ(tables[1].rows.size(), 2u) << "of both plants";
  EXPECT_THAT(plain_text(tables[2]), HasSubstr("mujoco:0.1"));
  EXPECT_THAT(plain_text(tables[3]), HasSubstr("too close"));
}

TEST(FaultedTwinTables, JsonKeepsEveryWrongTrial) {
  const auto json = faulted_twin_value(three_trials());
  const auto& second = json.at("plants").at(1);
  EXPECT_EQ(second.at("plant"), "mujoco:0.1");
  EXPECT_EQ(second.at("judgements").at("wrong reason"), 1);
  EXPECT_EQ(second.at("difference").at("gap_um").at("max"), 3);
  EXPECT_EQ(second.at("wrong").at(0).at("trial"), 2);
  EXPECT_EQ(second.at("least_gap_um"), 50);
  EXPECT_EQ(json.at("left_out").at(0).at("machine_seed"), "5");
}

}  // namespace
}  // namespace understudy::report
