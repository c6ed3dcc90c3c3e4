#include "machine/draft/urdf_ends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

std::string joint(const std::string& type, const std::string& parent, const std::string& child) {
  return "<joint name='" + parent + "-" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child +
         "'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint><link name='" +
         child + "'/>";
}

std::string tool_of(const std::string& joints) {
  const TemporaryFolder folder;
  write_file(folder / "arm.urdf", "<robot name='r'><link name='world'/>" + joints + "</robot>");
  const UrdfEnds ends = likely_ends(folder / "arm.urdf");
  EXPECT_EQ(ends.base, "world");
  return ends.tool;
}

const std::string kTwo =
    joint("fixed", "world", "base") + joint("revolute", "base", "one") + joint("revolute", "one", "two");

TEST(UrdfEnds, AFlangeOfAUsualNameIsTheTool) {
  EXPECT_EQ(tool_of(kTwo + joint("fixed", "two", "camera") + joint("fixed", "two", "tool0")), "tool0");
  EXPECT_EQ(tool_of(kTwo + joint("fixed", "two", "left_tcp")), "left_tcp");
}

TEST(UrdfEnds, ElseTheLastLinkBeforeTheFingers) {
  EXPECT_EQ(tool_of(kTwo), "two");
  EXPECT_EQ(tool_of(kTwo + joint("fixed", "two", "hand") + joint("prismatic", "hand", "left") +
                    joint("prismatic", "hand", "right")),
            "hand");
}

TEST(UrdfEnds, AGripperOfOneJointIsNoPartOfTheArm) {
  EXPECT_EQ(tool_of(kTwo + joint("revolute", "two", "gripper_mover")), "two");
}

TEST(UrdfEnds, ANameOnTheWayIsNoTool) {
  EXPECT_EQ(tool_of(joint("revolute", "world", "base_tool0") + joint("revolute", "base_tool0", "two")),
            "two");
}

TEST(UrdfEnds, WhatDoesNotMoveHasNone) { EXPECT_THROW(tool_of(joint("fixed", "world", "base")), InputError); }

}  // namespace
}  // namespace understudy::machine
