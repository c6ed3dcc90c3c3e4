#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string line_of(const std::string& text, const std::string& first_word) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(first_word + " ", 0) == 0) return line;
  return "";
}

TEST(Machines, OneLineEachWithAxesAndRanges) {
  const Outcome outcome = understudy("machines");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // Figures of models/*/machine.yaml.
  EXPECT_THAT(line_of(outcome.out, "hexapod"), HasSubstr("l1-l6 170..240 mm"));
  EXPECT_THAT(line_of(outcome.out, "arm"), HasSubstr("j1 -170..170 deg, j2 -45..150 deg"));
  EXPECT_THAT(line_of(outcome.out, "five-axis"), HasSubstr("x-y -110..110 mm, z -40..200 mm"));
  EXPECT_THAT(line_of(outcome.out, "five-axis"), HasSubstr("c endless"));
  EXPECT_THAT(line_of(outcome.out, "finishing"), HasSubstr("end mill 3.0 mm"));
}

TEST(Export, MjcfOfEveryMachine) {
  const Folder folder;
  for (const char* machine : {"hexapod", "arm", "five-axis", "finishing"}) {
    const std::string file = folder / (std::string(machine) + ".xml");
    const Outcome outcome = understudy(std::string("export mjcf --machine ") + machine + " -o " + file);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(read_file(file), StartsWith("<mujoco"));
  }
}

TEST(Export, UrdfOfEveryOpenChainHasItsJointsAndMasses) {
  const Folder folder;
  const std::vector<std::pair<std::string, std::vector<std::string>>> machines{
      {"arm", {"j1", "j2", "j3", "j4", "j5", "j6"}},
      {"five-axis", {"x", "y", "z", "b", "c"}},
      {"finishing", {"z", "c", "x", "y", "yaw", "pitch"}},
  };
  for (const auto& [machine, axes] : machines) {
    const std::string file = folder / (machine + ".urdf");
    const Outcome outcome = understudy("export urdf --machine " + machine + " -o " + file);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string urdf = read_file(file);
    for (const auto& axis : axes) EXPECT_THAT(urdf, HasSubstr("joint name=\"" + axis + "\"")) << machine;
    EXPECT_THAT(urdf, HasSubstr("link name=\"tool\""));
    EXPECT_THAT(urdf, HasSubstr("<mass"));
  }
}

TEST(Export, UrdfRefusesTheLoopsOfAHexapod) {
  const Folder folder;
  const Outcome outcome = understudy("export urdf --machine hexapod -o " + (folder / "hexapod.urdf"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("loops"));
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace understudy::cli_test
