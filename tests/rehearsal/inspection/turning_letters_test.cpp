#include "rehearsal/inspection/turning_letters.h"

#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

TEST(TurningLetters, AreThoseOfMoves) {
  EXPECT_EQ(turning_letters("G1 X1 B20 C-3\n", 'E'), "BC");
  EXPECT_EQ(turning_letters("G1 X1 A5 ; B3\n(C4)\nM555 W32\n", 'E'), "A");
  EXPECT_EQ(turning_letters("G1 X1 A5\n", 'A'), "") << "it feeds filament";
  EXPECT_EQ(turning_letters("N10 G1 W0.9 I0 J0 K0.4\n", 'E'), "") << "a quaternion";
}

TEST(TurningLetters, AnAxisThatStaysAtZeroBelongsToTheOneThatTurns) {
  EXPECT_EQ(turning_letters("G1 X1 A0 C30\n", 'E'), "AC");
  EXPECT_EQ(turning_letters("G1 X1 A3 B5 C0\n", 'E'), "AB");
  EXPECT_EQ(turning_letters("G1 X1 A3 B5 C6\n", 'E'), "ABC");
}

TEST(TurningLetters, HomingLevellingAndZerosTurnNothing) {
  EXPECT_EQ(turning_letters("G28 X0 U5\n", 'E'), "");
  EXPECT_EQ(turning_letters("G29 P9 X120 Y96 W32 H4\n", 'E'), "");
  EXPECT_EQ(turning_letters("G90 G01 X0 Y0 Z0 A0 B0 C0.000 F1000\n", 'E'), "");
}

TEST(TurningLetters, WordsAreTakenOutOfLinesAndLeftInComments) {
  EXPECT_EQ(without_words("G1 X1C20Y2 ; C3\nM104 S2\n", "C"), "G1 X1Y2 ; C3\nM104 S2\n");
}

}  // namespace
}  // namespace understudy::rehearsal
