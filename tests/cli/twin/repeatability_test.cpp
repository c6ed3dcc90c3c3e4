#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

TEST(RepeatabilityCommand, TellsWhatItWrites) {
  const Folder folder;
  const std::string out = folder / "out";
  const Outcome outcome = understudy(
      "repeatability --machine arm --centre -50 0 100 --lean 45 --cycles 5 --tests 2 --out " + out);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 tests of 5 approaches"));
  const auto json = nlohmann::json::parse(read_file(out + "/repeatability.json"));
  EXPECT_EQ(json.at("machine"), "arm");
  EXPECT_EQ(json.at("poses").size(), 5);
  double sum = 0;
  for (const auto& pose : json.at("poses")) sum += pose.at("repeatability_um").get<double>();
  EXPECT_NEAR(json.at("mean_um").get<double>(), sum / 5, 1e-3);
  EXPECT_EQ(json.at("poses")[1].at("x_mm"), 50) << "0.4 edges of 250 mm from the centre";
}

TEST(RepeatabilityCommand, ACubeOutOfReachIsOneLineAndNothingWritten) {
  const Folder folder;
  const Outcome outcome =
      understudy("repeatability --machine arm --centre 0 0 900 --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("arm does not reach"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace understudy::cli_test
