#include "toolpath/robot/robot_program.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/complaint.h"
#include "tests/temporary_folder.h"

namespace understudy::toolpath {
namespace {

TEST(RobotProgram, ItsLanguageIsToldByItsEndingAndElseByItsText) {
  EXPECT_EQ(robot_language("a.src", ""), RobotLanguage::krl);
  EXPECT_EQ(robot_language("a.SRC", "G1 X1"), RobotLanguage::krl);
  for (const char* name : {"a.mod", "a.modx", "a.prg", "a.sys"})
    EXPECT_EQ(robot_language(name, ""), RobotLanguage::rapid);
  EXPECT_EQ(robot_language("a.txt", "; a comment\n\n&ACCESS RVP\n"), RobotLanguage::krl);
  EXPECT_EQ(robot_language("a.txt", "  DEF part( )\n"), RobotLanguage::krl);
  EXPECT_EQ(robot_language("a.txt", "! generated\nMODULE m\n"), RobotLanguage::rapid);
  EXPECT_FALSE(robot_language("a.gcode", "; MODULE m\nG1 X1\n"));
  EXPECT_FALSE(robot_language("a.gcode", ""));
}

TEST(RobotProgram, OneThatIsLargerThanAnyIsRefused) {
  std::string text;
  text.resize(200'000'001, ' ');
  EXPECT_EQ(understudy::complaint([&] { read_robot_program("a.mod", text, {}); }),
            "a.mod: larger than 200 MB, as no program of a robot is");
}

TEST(RobotProgram, TheDataListBesideAProgramIsReadWithIt) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "part.src";
  std::ofstream(folder.path() / "part.dat")
      << "DEFDAT part\nDECL POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 180}\nENDDAT\n";
  const std::string text = "DEF part( )\nPTP XP1\nEND\n";
  const Program program = read_robot_program(path, text, {});
  ASSERT_EQ(program.steps.size(), 1u);
  EXPECT_TRUE(program.steps[0].X_WT.translation().isApprox(Vec3(1e-3, 2e-3, 3e-3), 1e-12));
  std::ofstream(folder.path() / "part.dat")
      << "DEFDAT part\nDECL POS XP1={X 4,Y 2,Z 3,A 0,B 0,C 180}\nENDDAT\n";
  EXPECT_NE(read_robot_program(path, text, {}).sha256, program.sha256) << "the data are part of the program";
  std::filesystem::remove(folder.path() / "part.dat");
  EXPECT_THROW(read_robot_program(path, text, {}), InputError);
}

}  // namespace
}  // namespace understudy::toolpath
