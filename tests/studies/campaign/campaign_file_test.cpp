#include "studies/campaign/campaign_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CampaignFile : public ::testing::Test {
 protected:
  CampaignFile() { std::ofstream(folder_ / "s.yaml") << "name: s\n"; }
  Campaign load(const std::string& rest) const {
    std::ofstream(folder_ / "c.yaml") << "name: c\nscenarios: [s.yaml]\nseeds: 1-40\n" << rest;
    return load_campaign(folder_ / "c.yaml");
  }
  std::string error(const std::string& rest) const {
    try {
      load(rest);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  const TemporaryFolder folder_;
};

TEST_F(CampaignFile, AGridHasValuesOrSteps) {
  const Campaign campaign = load(
      "parameters:\n  - {key: machine.a, values: [0.12, quasistatic]}\n  - {key: machine.b, from: 1, to: 2, "
      "steps: 3}\n"
      "  - {key: machine.c, from: 1, to: 100, steps: 3, scale: logarithmic}\n");
  EXPECT_THAT(campaign.parameters[0].values, ElementsAre("0.12", "quasistatic"));
  EXPECT_THAT(campaign.parameters[1].values, ElementsAre("1", "1.5", "2"));
  EXPECT_THAT(campaign.parameters[2].values, ElementsAre("1", "10", "100"));
  EXPECT_EQ(campaign.seeds(), 40u);
  EXPECT_EQ(campaign.level, 0.95);
}

TEST_F(CampaignFile, WhatDoesNotGoTogetherIsRefusedWithItsLine) {
  EXPECT_THAT(error("parameters:\n  - {key: machine.a, from: 2, to: 1, steps: 3}\n"),
              HasSubstr("c.yaml:5:31: machine.a runs from 2 to 1: an empty range"));
  EXPECT_THAT(error("parameters:\n  - {key: machine.a, values: []}\n"), HasSubstr("an empty list"));
  EXPECT_THAT(error("plan: sobol\nparameters:\n  - {key: machine.a, values: [1]}\n"),
              HasSubstr("'values' are those of a grid; a plan sobol needs 'from' and 'to'"));
  EXPECT_THAT(error("plan: sobol\n"), HasSubstr("a plan sobol needs parameters"));
  EXPECT_THAT(error("plan: sobl\n"), HasSubstr("did you mean 'sobol'?"));
  EXPECT_THAT(error("parameters:\n  - {key: a.b, values: [1]}\n  - {key: a.b, values: [2]}\n"),
              HasSubstr("c.yaml:6:5: parameter a.b is told twice"));
  EXPECT_THAT(error("metrics: [gap.strt_mm]\n"), HasSubstr("did you mean 'gap.start_mm'?"));
  EXPECT_THAT(error("metrics: [timing.wall_s]\n"), HasSubstr("is no figure of the print"));
  EXPECT_THAT(error("stop: {half_width: 0.05, first: 50}\n"),
              HasSubstr("the first look is after 50 machines, and there are 40"));
  EXPECT_THAT(error("paramters: []\n"), HasSubstr("unknown key 'paramters', did you mean 'parameters'?"));
  EXPECT_THAT(error("parameters:\n  - {key: machine.a, from: 0, to: 1, steps: 99999}\n  - {key: machine.b, "
                    "from: 0, to: 1, steps: 99}\n"),
              HasSubstr("the grid has 9899901 points, more than 100000"));
}

// Of few bytes each makes a list of 100 000 values: a file of 300 kB would need 20 GB.
TEST_F(CampaignFile, MoreThanAHundredParametersAreRefused) {
  std::string text = "parameters:\n";
  for (int i = 0; i < 101; ++i)
    text += "  - {key: machine.a" + std::to_string(i) + ", from: 0, to: 1, steps: 2}\n";
  EXPECT_THAT(error(text), HasSubstr("c.yaml:105:5: more than 100 parameters"));
}

TEST_F(CampaignFile, SeedsAreARange) {
  for (const char* seeds : {"5", "9-3", "a-b", "1-"}) {
    std::ofstream(folder_ / "c.yaml") << "name: c\nscenarios: [s.yaml]\nseeds: " << seeds << "\n";
    EXPECT_THROW(load_campaign(folder_ / "c.yaml"), InputError) << seeds;
  }
}

TEST_F(CampaignFile, AScenarioThatIsNotThereIsNamed) {
  std::ofstream(folder_ / "c.yaml") << "name: c\nscenarios: [none.yaml]\nseeds: 1-2\n";
  try {
    load_campaign(folder_ / "c.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.yaml does not exist"));
  }
}

}  // namespace
}  // namespace understudy::studies
