#include "toolpath/gcode/gcode_salvage.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

std::string described(const char* line, const Letters& letters = {}, bool arc = false) {
  const auto salvaged = salvage(line, letters, arc);
  if (!salvaged) return "refused";
  if (!salvaged->moves) return "no move";
  std::string words;
  for (const Word& word : salvaged->words) words += std::string(word.text) + " ";
  return words + "| " + salvaged->named + " | " + salvaged->lost;
}

TEST(GcodeSalvage, TellsWhichNumbersCanBeRead) {
  EXPECT_EQ(described("N7 G1 X1.2.3 Y-5 e.5F600 ; Z9"), "G1 Y-5 e.5 F600 | XYE | X");
  EXPECT_EQ(described("G1X1e-3Y2"), "G1 X1e-3 Y2 | XY | ");
  EXPECT_EQ(described("g0 x y 2"), "g0 y 2 | XY | X");
  EXPECT_EQ(described("G1 X1 X2 Y3"), "G1 Y3 | XY | X");
  EXPECT_EQ(described("G1 X1 @ Y3"), "G1 Y3 | XY | X");
  EXPECT_EQ(described("G1 X1 E1G1 Y3"), "G1 | XEY | XEY");
}

TEST(GcodeSalvage, OfAnOrientationAllOrNothing) {
  EXPECT_EQ(described("G1 X1 I0 J0 Ka"), "refused") << "a is a letter of another kind of machine";
  EXPECT_EQ(described("G1 X1 I0 J0 K-"), "G1 X1 | XW | W");
  EXPECT_EQ(described("G2 X1 I0 J-"), "G2 X1 | X | ");
  EXPECT_EQ(described("X1 I0 J-", {}, true), "X1 | X | ") << "an arc is in force";
}

TEST(GcodeSalvage, LettersAreThoseOfTheDialect) {
  Letters letters;
  letters.rotary = "AC";
  letters.extruder = 'U';
  EXPECT_EQ(described("G1 X1 A- C5 U2", letters), "G1 X1 C5 U2 | XBCE | B");
  EXPECT_EQ(described("G1 X1 E-", letters), "refused");
  EXPECT_EQ(described("G1 X1 A-"), "refused");
}

TEST(GcodeSalvage, OnlyMovesTemperaturesFansAndDwellsMayBeMissed) {
  for (const char* line : {"M104 S-", "M109 S1 S2", "M106 P1 S300", "G4"})
    EXPECT_EQ(described(line), "no move") << line;
  for (const char* line : {"", "; x", "N5", "G21 X-", "G- X1", "M", "T9", "G1 X1 M104 S-", "M104 X1",
                           "G0 G1 X1", "G1 X#1", "G1 X\x7f", "?G1 X1", "START_PRINT"})
    EXPECT_EQ(described(line), "refused") << line;
}

}  // namespace
}  // namespace understudy::toolpath
