#include "toolpath/gcode/words/gcode_lexer.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

std::string complaint(const std::string& line) {
  try {
    lex_line(line, "p.gcode", 7);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(GcodeLexer, WordsAreALetterAndANumberWithOrWithoutBlanks) {
  const auto words = lex_line("g1X-.5 Y +2.\tz 3.25", "p.gcode", 1);
  ASSERT_EQ(words.size(), 4u);
  const struct {
    char letter;
    double value;
    int column;
    std::string text;
  } expected[] = {{'G', 1, 1, "g1"}, {'X', -0.5, 3, "X-.5"}, {'Y', 2, 8, "Y +2."}, {'Z', 3.25, 14, "z 3.25"}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(words[i].letter, expected[i].letter);
    EXPECT_EQ(words[i].value, expected[i].value);
    EXPECT_EQ(words[i].column, expected[i].column);
    EXPECT_EQ(words[i].text, expected[i].text);
    EXPECT_FALSE(words[i].bare);
  }
}

TEST(GcodeLexer, CommentsAndBlankLinesHaveNoWords) {
  EXPECT_TRUE(lex_line("", "p.gcode", 1).empty());
  EXPECT_TRUE(lex_line(" \t\r", "p.gcode", 1).empty());
  EXPECT_TRUE(lex_line("; G1 X1", "p.gcode", 1).empty());
  EXPECT_EQ(lex_line("G1 (to the left) X1 ; G0", "p.gcode", 1).size(), 2u);
}

TEST(GcodeLexer, AnEAfterANumberIsAWordAndNoExponent) {
  const auto words = lex_line("G1 X1E2", "p.gcode", 1);
  ASSERT_EQ(words.size(), 3u);
  EXPECT_EQ(words[1].value, 1);
  EXPECT_EQ(words[2].letter, 'E');
  EXPECT_EQ(words[2].value, 2);
}

TEST(GcodeLexer, ALetterAloneIsBareAndATextIsQuoted) {
  const auto words = lex_line("G28 X Y(now) P\"M 3\"", "p.gcode", 1);
  ASSERT_EQ(words.size(), 4u);
  EXPECT_TRUE(words[1].bare);
  EXPECT_TRUE(words[2].bare);
  EXPECT_TRUE(words[3].quoted);
  EXPECT_EQ(words[3].text, "P\"M 3\"");
}

TEST(GcodeLexer, WhatIsNoWordIsRefusedWithItsPlace) {
  EXPECT_THAT(complaint("G1 #2"), HasSubstr("p.gcode:7:4: 'G1 #2': variables and expressions are not read"));
  EXPECT_THAT(complaint("G1 X[1+2] ; no"), HasSubstr("p.gcode:7:5: 'G1 X[1+2] ': variables and expr"));
  EXPECT_THAT(complaint("o<prime> call"), HasSubstr("p.gcode:7:1: 'o<prime> call': O words (subroutines"));
  EXPECT_THAT(complaint("G1 X1.2.3"), HasSubstr("p.gcode:7:4: 'X1.2.3': X needs a finite decimal number"));
  EXPECT_THAT(complaint("G1 Xa"), HasSubstr("X needs a finite decimal number"));
  EXPECT_THAT(complaint("G1 X" + std::string(400, '9')), HasSubstr("X needs a finite decimal number"));
  EXPECT_EQ(complaint("G1 X0." + std::string(400, '0') + "1"), "accepted") << "too small is zero";
  EXPECT_THAT(complaint("G1 (open"), HasSubstr("p.gcode:7:4: the comment '(' is not closed"));
  EXPECT_THAT(complaint("M862.3 P\"open"), HasSubstr("is not closed on its line"));
  EXPECT_THAT(complaint("G1 \x1b[2J"), HasSubstr("'\\x1b' starts no word"))
      << "no control character is echoed";
}

TEST(GcodeLexer, AnyBytesAreWordsOrAnInputError) {
  Random random(21, "lexer bytes");
  const std::string alphabet = "GXYZE0123456789.+-;() \"\t#\x01\x7f\xff";
  for (int n = 0; n < 20000; ++n) {
    std::string line;
    for (int k = static_cast<int>(random.uniform(0, 20)); k > 0; --k)
      line += alphabet[static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(alphabet.size()))];
    try {
      for (const Word& word : lex_line(line, "p.gcode", 1)) {
        EXPECT_TRUE(word.letter >= 'A' && word.letter <= 'Z');
        EXPECT_EQ(line.substr(static_cast<std::size_t>(word.column) - 1, word.text.size()), word.text);
      }
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace understudy::toolpath
