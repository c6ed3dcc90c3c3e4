// What senders hear, byte for byte. Answers are those of grbl's interface (grbl v1.1, "Interface") and of
// Marlin's G-code pages; the machine's clock is the test's.
#include "rehearsal/serving/controller_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/program/gcode_options.h"

namespace understudy::rehearsal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Sender {
  explicit Sender(const std::string& dialect)
      : machine(machine::load_machine("hexapod")),
        served(machine, control::gcode_options({}, machine), planner_blocks(dialect)),
        session(make_session(dialect, served)) {}

  /// Sends, and hears what comes by `seconds` later.
  std::string send(const std::string& bytes, double seconds = 0) {
    session->receive(bytes);
    session->tick(now);
    now += seconds;
    session->tick(now);
    return session->take_output();
  }
  /// Until the tool rests.
  std::string wait() {
    std::string heard;
    for (int i = 0; i < 10'000 && !(served.idle() && session->quiet()); ++i) heard += send("", 0.05);
    return heard;
  }

  machine::MachineDescription machine;
  ServedMachine served;
  std::unique_ptr<ControllerSession> session;
  double now = 0;
};

std::string with_checksum(const std::string& line) {
  unsigned sum = 0;
  for (const char c : line) sum ^= static_cast<unsigned char>(c);
  return line + "*" + std::to_string(sum) + "\n";
}

TEST(GrblSession, AnswersOkOnceALineIsPlannedAndTellsWhereItIs) {
  Sender sender("grbl");
  sender.session->greet();
  EXPECT_THAT(sender.send("?"),
              AllOf(HasSubstr("GrblHAL 1.1f"), HasSubstr("<Idle|MPos:0.000,0.000,50.000|")));
  EXPECT_EQ(sender.send("G1 X6 F600\n"), "ok\r\n");
  // 6 mm at 10 mm/s and 300 mm/s2: after 0.3 s the tool has gone 10 (0.3 - 0.5 / 30) mm = 2.8 mm.
  EXPECT_THAT(sender.send("?", 0.3), HasSubstr("<Run|"));
  EXPECT_NEAR(sender.served.X_WT().translation().x(), 2.83e-3, 0.03e-3) << "a cycle of 1 ms is 0.01 mm";
  sender.wait();
  EXPECT_THAT(sender.send("?"), HasSubstr("<Idle|MPos:6.000,0.000,50.000|"));
}

TEST(GrblSession, ALineWaitsForItsOkWhileThePlannerIsFull) {
  Sender sender("grbl");
  std::string lines, heard;
  const int count = planner_blocks("grbl") + 5;
  for (int i = 0; i < count; ++i) lines += i % 2 == 0 ? "G1 X1 F600\n" : "G1 X0\n";
  std::size_t sent = 0;
  const auto oks = [&] {
    std::size_t n = 0;
    for (std::size_t at = heard.find("ok"); at != std::string::npos; at = heard.find("ok", at + 1)) ++n;
    return static_cast<int>(n);
  };
  while (sent < lines.size()) {
    const std::size_t room = sender.session->room();
    heard += sender.send(lines.substr(sent, room));
    sent += std::min(room, lines.size() - sent);
  }
  EXPECT_EQ(oks(), planner_blocks("grbl")) << "no time has passed, so no block is free";
  heard += sender.wait();
  EXPECT_EQ(oks(), count);
}

TEST(GrblSession, NamesErrorsByTheirNumbers) {
  Sender sender("grbl");
  EXPECT_THAT(sender.send("G1 X1\n"), HasSubstr("error:22")) << "no feed";
  EXPECT_THAT(sender.send("M428\n"), HasSubstr("error:20"));
  EXPECT_THAT(sender.send("G1 X1.2.3 F600\n"), HasSubstr("error:2\r"));
  EXPECT_THAT(sender.send("$BAD\n"), HasSubstr("error:3"));
  EXPECT_THAT(sender.send("G1 X" + std::string(300, '0') + "\n"), HasSubstr("error:11"));
  EXPECT_EQ(sender.send("\n"), "ok\r\n");
  EXPECT_EQ(sender.served.moves(), 0);
}

TEST(GrblSession, AMoveBeyondALimitIsAnAlarmThatLocks) {
  Sender sender("grbl");
  EXPECT_THAT(sender.send("G1 X500 F600\n"),
              AllOf(HasSubstr("[MSG:"), HasSubstr("ALARM:2"), Not(HasSubstr("ok"))));
  EXPECT_THAT(sender.send("G1 X1 F600\n?"), AllOf(HasSubstr("error:9"), HasSubstr("<Alarm|")));
  EXPECT_THAT(sender.send("$X\nG1 X1 F600\n"), AllOf(HasSubstr("Unlocked"), HasSubstr("ok\r\nok\r\n")));
  EXPECT_EQ(sender.served.refused(), 1);
  EXPECT_THAT(sender.served.text(), AllOf(HasSubstr("; refused: G1 X500"), HasSubstr("\nG1 X1 F600\n")));
}

TEST(GrblSession, WordsThatItRepeatsAreText) {
  Sender sender("grbl");
  EXPECT_THAT(sender.send("G1 X1 F\t\t-180\n"), AllOf(HasSubstr("[MSG:"), Not(HasSubstr("\t"))));
}

TEST(GrblSession, AMoveThatTakesForEverIsRefused) {
  Sender sender("grbl");
  EXPECT_THAT(sender.send("G1 X1 F1e-180\n"), AllOf(HasSubstr("more than 86400 s"), HasSubstr("ALARM:2")));
  EXPECT_THAT(sender.send("$X\nG1 X1 F0.001\n"), HasSubstr("ok\r\nok\r\n")) << "1000 minutes";
  EXPECT_EQ(sender.served.moves(), 1);
}

TEST(GrblSession, HoldStopsTheClockAndResumeGoesOn) {
  Sender sender("grbl");
  sender.send("G1 X6 F600\n", 0.3);
  sender.send("!");
  const Vec3 held = sender.served.X_WT().translation();
  EXPECT_THAT(sender.send("?", 5), HasSubstr("<Hold:0|"));
  EXPECT_EQ(sender.served.X_WT().translation(), held);
  sender.send("~", 5);
  EXPECT_NEAR(sender.served.X_WT().translation().x(), 6e-3, 1e-9);
}

TEST(GrblSession, AResetWhileItMovesEndsThePrint) {
  Sender sender("grbl");
  sender.send("G1 X6 F600\n", 0.3);
  EXPECT_THAT(sender.send("\x18"), AllOf(HasSubstr("ALARM:3"), HasSubstr("GrblHAL")));
  EXPECT_TRUE(sender.session->aborted());
  EXPECT_FALSE(sender.served.whole());
}

// As much as the buffer takes at a time, as the line hands it over.
std::string send_by_room(Sender& sender, const std::string& bytes) {
  std::string heard;
  for (std::size_t sent = 0; sent < bytes.size();) {
    const std::size_t room = std::min(sender.session->room(), bytes.size() - sent);
    EXPECT_GT(room, 0u) << "after " << sent << " bytes";
    if (room == 0) break;
    heard += sender.send(bytes.substr(sent, room));
    sent += room;
  }
  return heard;
}

TEST(GrblSession, NothingBehindTheEndIsOfTheProgram) {
  Sender sender("grbl");
  EXPECT_EQ(sender.send("G1 X1 F600\nM2\n$H\nG1 X2\n", 2), "ok\r\n[MSG:Pgm End]\r\nok\r\nok\r\nok\r\n");
  EXPECT_EQ(sender.served.text(), "G1 X1 F600\nM2\n");
}

TEST(GrblSession, ALineLongerThanTheBufferIsRefusedAndTheNextOneTaken) {
  Sender sender("grbl");
  EXPECT_EQ(send_by_room(sender, std::string(5000, 'X') + "\nG1 X1 F600\n"), "error:11\r\nok\r\n");
  EXPECT_EQ(send_by_room(sender, "G1 X2 ; " + std::string(5000, '-') + "\n"), "ok\r\n")
      << "grbl throws comments away as they come";
}

TEST(MarlinSession, ALineLongerThanTheBufferIsRefusedAndTheNextOneTaken) {
  Sender sender("marlin");
  EXPECT_THAT(send_by_room(sender, std::string(5000, 'X') + "\n"),
              AllOf(StartsWith("echo:Unknown command: \"XXX"), HasSubstr("ok\r\n")));
  EXPECT_EQ(send_by_room(sender, "G1 X2 F600 ; " + std::string(5000, '-') + "\n"), "ok\r\n");
  EXPECT_EQ(sender.served.moves(), 1);
}

TEST(MarlinSession, AnswersANumberAlone) {
  Sender sender("marlin");
  EXPECT_EQ(sender.send(with_checksum("N0 M110 N0") + with_checksum("N1 ; a comment")), "ok\r\nok\r\n");
}

TEST(MarlinSession, TheLastLineNumberHasNoNext) {
  Sender sender("marlin");
  EXPECT_EQ(sender.send(with_checksum("N0 M110 N9223372036854775807")), "ok\r\n");
  EXPECT_THAT(sender.send(with_checksum("N2147483647 G1 X1 F600")),
              HasSubstr("Error:Line Number is not Last Line Number+1, Last Line: 2147483646\r\n"));
  EXPECT_THAT(sender.send(with_checksum("N9223372036854775807 M110")), HasSubstr("Resend: 2147483647\r\n"));
}

TEST(MarlinSession, AnswersQueriesBeforeTheirOk) {
  Sender sender("marlin");
  sender.session->greet();
  EXPECT_THAT(sender.send("M115\n"),
              AllOf(StartsWith("start\r\n"), HasSubstr("FIRMWARE_NAME:Marlin"), HasSubstr("\nok\r\n")));
  EXPECT_THAT(sender.send("M105\n"), StartsWith("ok T:25.00 /0.00 B:25.00"));
  sender.send("M104 S210\n");
  EXPECT_THAT(sender.send("M105\n"), StartsWith("ok T:210.00 /210.00"));
  EXPECT_THAT(sender.send("M114\n"), StartsWith("X:0.00 Y:0.00 Z:50.00 E:0.00 Count"));
}

TEST(MarlinSession, AsksAgainForWhatDoesNotFit) {
  Sender sender("marlin");
  EXPECT_EQ(sender.send(with_checksum("N0 M110 N0")), "ok\r\n");
  EXPECT_EQ(sender.send(with_checksum("N1 G1 X1 F600")), "ok\r\n");
  EXPECT_EQ(sender.send("N2 G1 X2*1\n"), "Error:checksum mismatch, Last Line: 1\r\nResend: 2\r\nok\r\n");
  EXPECT_EQ(sender.send(with_checksum("N3 G1 X2")),
            "Error:Line Number is not Last Line Number+1, Last Line: 1\r\nResend: 2\r\nok\r\n");
  EXPECT_EQ(sender.send("N2 G1 X2\n"),
            "Error:No Checksum with line number, Last Line: 1\r\nResend: 2\r\nok\r\n");
  EXPECT_EQ(sender.send(with_checksum("N2 G1 X2")), "ok\r\n");
  EXPECT_EQ(sender.served.text(), "G1 X1 F600\nG1 X2\n") << "as a file: without what guards the line";
}

TEST(MarlinSession, WaitsForRestWhereMarlinDoesAndStaysBusy) {
  Sender sender("marlin");
  sender.send("G1 X30 F600\n");
  std::string heard = sender.send("M400\n", 2.5);
  EXPECT_THAT(heard, AllOf(HasSubstr("echo:busy: processing"), Not(HasSubstr("ok"))));
  EXPECT_THAT(sender.wait(), HasSubstr("ok"));
  EXPECT_NEAR(sender.now, 3.1, 0.15) << "30 mm at 10 mm/s, and the poll of the test";
}

TEST(MarlinSession, GoesOnBehindALineThatItDoesNotKnow) {
  Sender sender("marlin");
  EXPECT_EQ(sender.send("M428\n"), "echo:Unknown command: \"M428\"\r\nok\r\n");
  EXPECT_THAT(sender.send("G1 X500 F600\n"), AllOf(StartsWith("Error:"), HasSubstr("ok\r\n")));
  EXPECT_EQ(sender.send("; a comment\n\n"), "") << "Marlin does not answer what has no command";
  EXPECT_EQ(sender.served.refused(), 2);
}

TEST(MarlinSession, KillEndsThePrint) {
  Sender sender("marlin");
  sender.send("G1 X6 F600\n", 0.3);
  EXPECT_THAT(sender.send("M112\n"), HasSubstr("Printer halted. kill() called!"));
  EXPECT_TRUE(sender.session->aborted());
}

}  // namespace
}  // namespace understudy::rehearsal
