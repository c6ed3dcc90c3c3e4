#include "toolpath/gcode/words/gcode_block.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

const std::string kFile = "p.gcode";

// A block keeps views of its line: the texts here are literals.
Block block(const char* line, Letters letters = {}) {
  return Block(lex_line(line, kFile, 4), kFile, 4, letters);
}

std::string complaint(const char* line, Letters letters = {}) {
  try {
    block(line, letters);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(GcodeBlock, CommandsAndParametersAreFoundByWhatTheyMean) {
  const Block b = block("G90 G1 X1 F600");
  EXPECT_TRUE(b.find(Command::absolute));
  EXPECT_TRUE(b.find(Command::linear));
  EXPECT_FALSE(b.find(Command::rapid));
  ASSERT_TRUE(b.find('F'));
  EXPECT_EQ(b.find('F')->value, 600);
  EXPECT_FALSE(b.find('Y'));
  EXPECT_EQ(b.find_any("YZX")->letter, 'X');
}

TEST(GcodeBlock, AParameterThatNobodyTookIsAnError) {
  Block b = block("G1 X1 Y2");
  b.take('X');
  try {
    b.check_all_taken();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:4:7"));
  }
  b.take('Y');
  EXPECT_NO_THROW(b.check_all_taken());
}

TEST(GcodeBlock, TwoCommandsOfOneGroupExcludeEachOther) {
  EXPECT_NE(complaint("G0 G1 X1"), "accepted");
  EXPECT_NE(complaint("G90 G91"), "accepted");
  EXPECT_NE(complaint("M104 M106 S5"), "accepted");
  EXPECT_EQ(complaint("G90 G21 G1 X1 M83"), "accepted") << "of four groups";
}

TEST(GcodeBlock, ALetterGivenTwiceOrUnknownIsRefusedWithItsPlace) {
  EXPECT_THAT(complaint("G1 X1 X2"), HasSubstr("p.gcode:4:7"));
  EXPECT_THAT(complaint("G6 X1"), HasSubstr("p.gcode:4:1"));
  EXPECT_THAT(complaint("G1 H1"), HasSubstr("p.gcode:4:4"));
}

TEST(GcodeBlock, LettersAreAsTheDialectUsesThem) {
  Letters extruder_a;
  extruder_a.extruder = 'A';
  EXPECT_EQ(complaint("G1 X1 A2", extruder_a), "accepted");
  EXPECT_EQ(block("G1 X1 A2", extruder_a).find('E')->value, 2) << "read as E";
  Letters rotary;
  rotary.rotary = "BC";
  EXPECT_EQ(complaint("G1 X1 B20 C30", rotary), "accepted");
  rotary.rotary = "AC";
  EXPECT_EQ(block("G1 X1 A20 C30", rotary).find('B')->value, 20) << "the first, read as B";
  EXPECT_THAT(complaint("G1 X1 B20", rotary), HasSubstr("the rotary axes of this machine are A and C"));
}

TEST(GcodeBlock, CommandsOfASlicerForItsFirmwareHaveNoEffect) {
  EXPECT_TRUE(block("M73 P10 R5").without_effect());
  EXPECT_TRUE(block("M84").without_effect());
  EXPECT_FALSE(block("M104 S210").without_effect());
}

}  // namespace
}  // namespace understudy::toolpath
