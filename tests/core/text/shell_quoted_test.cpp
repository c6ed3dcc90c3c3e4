#include "core/text/shell_quoted.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(ShellQuoted, QuotesWhatAShellWouldReadOtherwise) {
  EXPECT_EQ(shell_quoted("scenarios/song-bottle.gcode"), "scenarios/song-bottle.gcode");
  EXPECT_EQ(shell_quoted("two words"), "'two words'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("$HOME"), "'$HOME'");
}

}  // namespace
}  // namespace understudy
