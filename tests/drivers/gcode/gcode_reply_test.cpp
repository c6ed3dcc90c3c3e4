#include "drivers/gcode/gcode_reply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::drivers {
namespace {

using Kind = Reply::Kind;

TEST(GcodeReply, IsToldFromWhatControllersSay) {
  EXPECT_EQ(parse_reply("ok").kind, Kind::ok);
  EXPECT_EQ(parse_reply("ok N12 P15 B3").kind, Kind::ok);
  EXPECT_EQ(parse_reply("Resend: 17\r").kind, Kind::resend);
  EXPECT_EQ(parse_reply("Resend: 17").number, 17);
  EXPECT_EQ(parse_reply("rs N4").number, 4);
  EXPECT_EQ(parse_reply("error:20").kind, Kind::error);
  EXPECT_EQ(parse_reply("error:20").number, 20);
  EXPECT_EQ(parse_reply("Error:Printer halted. kill() called!").kind, Kind::error);
  EXPECT_EQ(parse_reply("echo:Unknown command: \"G93\"").kind, Kind::error);
  EXPECT_EQ(parse_reply("ALARM:1").kind, Kind::alarm);
  EXPECT_EQ(parse_reply("start").kind, Kind::banner);
  EXPECT_EQ(parse_reply("GrblHAL 1.1f ['$' or '$HELP' for help]").kind, Kind::banner);
  EXPECT_EQ(parse_reply("echo:busy: processing").kind, Kind::busy);
  EXPECT_EQ(parse_reply("T:203.1 /210.0 B:0.0 /0.0").kind, Kind::busy);
}

TEST(GcodeReply, OfNoiseIsOther) {
  for (const char* noise : {"", "okay", "k", "o\xc3", "<Idle|MPos:1.0,2.", "<Idle|MPos:1.0,x>", "<>",
                            "X:1.0 Y:", "Resend: seven", "ALARM:", "rs"})
    EXPECT_EQ(parse_reply(noise).kind, Kind::other) << noise;
}

TEST(GcodeReply, StatusHasStatePositionsAndLine) {
  const Reply reply = parse_reply("<Hold:0|WPos:1.500,-2.000,3|Bf:15,128|Ln:99|FS:0,0|WCO:0.5,0,0>");
  ASSERT_EQ(reply.kind, Kind::status);
  EXPECT_EQ(reply.status.state, "Hold");
  EXPECT_THAT(reply.status.work, testing::ElementsAre(1.5, -2, 3));
  EXPECT_THAT(reply.status.work_offset, testing::ElementsAre(0.5, 0, 0));
  EXPECT_TRUE(reply.status.machine.empty());
  EXPECT_EQ(reply.status.line, 99);
  EXPECT_EQ(reply.status.planner_free, 15);
}

TEST(GcodeReply, APlannerHasRoomForACountOfBlocks) {
  for (const char* free : {"1e30", "-1", "nan"})
    EXPECT_EQ(parse_reply(std::string("<Idle|Bf:") + free + ",128>").kind, Kind::other) << free;
  EXPECT_EQ(parse_reply("<Idle|Bf:1023,128>").status.planner_free, 1023);
}

TEST(GcodeReply, PositionEndsAtCount) {
  const Reply reply = parse_reply("X:10.25 Y:0.00 U:-3.10 E:0.00 Count X:800 Y:0 Z:0");
  ASSERT_EQ(reply.kind, Kind::position);
  EXPECT_THAT(reply.words, testing::ElementsAre(testing::Pair('X', 10.25), testing::Pair('Y', 0.0),
                                                testing::Pair('U', -3.1), testing::Pair('E', 0.0)));
}

}  // namespace
}  // namespace understudy::drivers
