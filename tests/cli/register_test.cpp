// `register`, and what it refuses, as a user runs it.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string contents(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(RegisterCommand, APatternThatThePartDoesNotCarryIsNamedByItsLine) {
  const Folder folder;
  const std::string pose = folder / "pose.yaml";
  const std::string pattern =
      folder.write("pattern.csv", "x_mm,y_mm,z_mm\n0,0,31\n0,10,31\n0,-10,31\n0,15,31\n0,-15,33\n0,5,31\n");
  const Outcome outcome = understudy("register --fixture bottle --pattern " + pattern + " -o " + pose);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("pattern.csv:6"), HasSubstr("off the drawn part"), HasSubstr("0.1 mm")));
  EXPECT_FALSE(fs::exists(pose));
}

TEST(RegisterCommand, SaysWhatItNeeds) {
  const Folder folder;
  const std::string to = " -o " + (folder / "pose.yaml");
  EXPECT_EQ(understudy("register" + to).status, 2);
  const Outcome blind = understudy("register --fixture bottle --machine finishing" + to);
  EXPECT_EQ(blind.status, 2);
  const Outcome few = understudy("register --fixture bottle --places 5" + to);
  EXPECT_EQ(few.status, 2);
  const Outcome without = understudy("rehearse nothing.gcode --fixture bottle --pattern p.csv");
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("--register"));
}

TEST(RegisterCommand, WritesThePoseWithItsCovariance) {
  const Folder folder;
  const std::string pose = folder / "pose.yaml";
  const Outcome outcome = understudy("register --fixture bottle --as-built nominal -o " + pose);
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("found"), HasSubstr("not seen, left as drawn"), HasSubstr("turn about")));
  const std::string text = contents(pose);
  for (const char* key : {"position_mm: [", "quaternion: [", "reference_mm: [", "covariance:\n  - [",
                          "unseen: [\"", "chi_square: "})
    EXPECT_THAT(text, HasSubstr(key));
}

}  // namespace
}  // namespace understudy::cli_test
