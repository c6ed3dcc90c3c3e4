// The corpus holds sessions that are printed to their end, so that it says something of lines that are done.
#include "tests/fuzz/controller_talk.h"

#include <gtest/gtest.h>

#include "core/file/read_file.h"

namespace understudy::fuzz {
namespace {

bool done(const std::string& input) {
  return talk(read_file(UNDERSTUDY_SOURCE_DIR "/tests/fuzz/corpus/controller_reply/" + input));
}

TEST(ControllerTalk, EndsWithEverythingDoneWhereTheControllerSaysSo) {
  for (const char* input : {"grbl_prints", "grbl_runs_on", "in_pieces_of_four_bytes", "marlin_prints",
                            "marlin_resends", "reprapfirmware_prints"})
    EXPECT_TRUE(done(input)) << input;
}

TEST(ControllerTalk, IsNotDoneWhereTheControllerDoesNotSaySo) {
  for (const char* input : {"grbl_stands_elsewhere", "grbl_ok_too_few", "grbl_ok_too_many", "grbl_error",
                            "grbl_boots_again", "marlin_halts", "another_controller", "silence"})
    EXPECT_FALSE(done(input)) << input;
}

}  // namespace
}  // namespace understudy::fuzz
