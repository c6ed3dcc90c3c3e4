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

// Each answer alone is one that a controller gives; all together they lead nowhere.
TEST(ControllerTalk, EndsWhereALineIsAcceptedAndAskedForAgainForEver) {
  std::string text =
      "\x01\x3f\fok\n\fFIRMWARE_NAME:Marlin 2.1\nok\n\fX:0.00 Y:0.00 Z:0.00 E:0.00 Count X:0 Y:0 Z:0\nok\n";
  for (int i = 0; i < 5000; ++i) text += "\fok\n\fok\n\fResend: 3\nok\n";
  EXPECT_FALSE(talk(text));
}

}  // namespace
}  // namespace understudy::fuzz
