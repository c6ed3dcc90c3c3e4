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
  for (const char* key : {"part: \"bottle\"", "part_sha256: ", "machine_sha256: ", "part_mm: [",
                          "part_quaternion: [", "reference_mm: [", "covariance_mm_rad: [", "unseen:"})
    EXPECT_THAT(text, HasSubstr(key));
}

/// One line, status 2, and no folder of results.
void expect_no_print(const std::string& words, const std::vector<std::string>& parts) {
  const Folder folder;
  const Outcome outcome = understudy("rehearse " + std::string(UNDERSTUDY_SOURCE_DIR) +
                                     "/scenarios/song-bottle.gcode " + words + " --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const auto& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

const std::string kPose = std::string(UNDERSTUDY_SOURCE_DIR) + "/scenarios/registration/bottle-pose.yaml";

TEST(PartPose, OfAnotherPartOrMachineIsRefused) {
  const Folder folder;
  const std::string shipped = contents(kPose);
  EXPECT_THAT(shipped, HasSubstr("part_sha256: "));
  expect_no_print("--fixture slanted_box --part-pose " + kPose,
                  {"bottle-pose.yaml", "another part", "understudy register"});
  const std::string other =
      folder.write("other.yaml", shipped + "machine_sha256: \"" + std::string(64, '0') + "\"\n");
  expect_no_print("--fixture bottle --part-pose " + other,
                  {"other.yaml", "another machine file", "understudy register"});
}

TEST(PartPose, NeedsThePartAndExcludesRegistering) {
  expect_no_print("--part-pose " + kPose, {"--fixture"});
  expect_no_print("--fixture bottle --register --part-pose " + kPose, {"--register", "--part-pose"});
  expect_no_print("--fixture bottle --part-pose none.yaml", {"none.yaml"});
}

}  // namespace
}  // namespace understudy::cli_test
