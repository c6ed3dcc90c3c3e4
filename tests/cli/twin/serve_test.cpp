// The command as senders meet it: over a pseudo-terminal and over TCP, with a sender written here and with
// Debian's pronsole.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/descriptor.h"
#include "core/file/read_file.h"
#include "tests/cli/background_run.h"

namespace understudy::cli_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{60};  // for a busy machine

/// A cube's edge of 10 mm: few lines, all of them moves of every kind.
const char* const kLines[] = {"G21",        "G90", "M83", "M104 S210", "G0 X-5 Y0 Z50", "G1 X5 E0.4 F1200",
                              "G1 Y5 E0.2", "M400"};

/// Reads until `what` has come.
std::string hear(int file, const std::string& what) {
  std::string heard;
  for (const auto end = Clock::now() + kPatience;
       Clock::now() < end && heard.find(what) == std::string::npos;) {
    pollfd look{file, POLLIN, 0};
    char bytes[256];
    if (::poll(&look, 1, 100) > 0) {
      const ssize_t count = ::read(file, bytes, sizeof bytes);
      if (count <= 0) break;
      heard.append(bytes, static_cast<std::size_t>(count));
    }
  }
  return heard;
}

void say(int file, const std::string& text) {
  ASSERT_EQ(::write(file, text.data(), text.size()), std::ssize(text));
}

TEST(ServeCommand, AScriptedSenderPrintsOnAPseudoTerminal) {
  const Folder folder;
  const std::string pty = folder / "twin", results = folder / "served";
  BackgroundRun server(
      folder, fmt::format("serve --machine hexapod --port pty:{} --speed 20 --gap-control off --out {}", pty,
                          results));
  ASSERT_THAT(server.first_output(), HasSubstr("hexapod listens as grbl on " + pty));
  {
    const Descriptor line(::open(pty.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    ASSERT_GE(line.get(), 0);
    EXPECT_THAT(hear(line.get(), "help]"), HasSubstr("GrblHAL 1.1f"));
    for (const char* text : kLines) {
      say(line.get(), std::string(text) + "\n");
      EXPECT_THAT(hear(line.get(), "\n"), HasSubstr("ok")) << text;
    }
    say(line.get(), "?");
    EXPECT_THAT(hear(line.get(), ">"), HasSubstr("|MPos:"));
    say(line.get(), "M30\n");
    EXPECT_THAT(hear(line.get(), "ok"), HasSubstr("[MSG:Pgm End]"));
  }
  EXPECT_LE(server.wait(), 1) << "a verdict, whichever";
  EXPECT_THAT(read_file(results + "/received.gcode"), HasSubstr("G1 X5 E0.4 F1200\nG1 Y5 E0.2\nM400\nM30\n"));
  const auto summary = nlohmann::json::parse(read_file(results + "/summary.json"));
  EXPECT_NEAR(summary.at("print").at("extruded_mm").get<double>(), 0.6, 1e-6);
  EXPECT_FALSE(fs::exists(fs::symlink_status(pty))) << "the link goes with the server";
}

TEST(ServeCommand, CtrlCEndsWithTheReportOfWhatHasCome) {
  const Folder folder;
  BackgroundRun server(folder, fmt::format("serve --machine hexapod --dialect marlin --port tcp:127.0.0.1:0 "
                                           "--speed 20 --gap-control off --out {}",
                                           folder / "served"));
  const std::string said = server.first_output();
  const auto colon = said.rfind(':');
  ASSERT_NE(colon, std::string::npos) << said;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(said.substr(colon + 1))));
  ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  const Descriptor line(::socket(AF_INET, SOCK_STREAM, 0)), second(::socket(AF_INET, SOCK_STREAM, 0));
  ASSERT_EQ(::connect(line.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(hear(line.get(), "Machine:"), HasSubstr("start\r\n"));
  for (const char* text : kLines) {
    say(line.get(), std::string(text) + "\n");
    EXPECT_THAT(hear(line.get(), "ok"), HasSubstr("ok")) << text;
  }
  ASSERT_EQ(::connect(second.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(hear(second.get(), "]"), HasSubstr("busy: one sender at a time"));
  server.interrupt();
  EXPECT_LE(server.wait(), 1);
  EXPECT_THAT(read_file(folder / "out"), HasSubstr("interrupted: 3 moves received, 0 lines refused"));
  EXPECT_TRUE(fs::exists(folder / "served/report.html"));
}

TEST(ExtendedServeCommand, PronsolePrintsOnTheTwin) {
  if (std::system("command -v pronsole >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs Debian's printrun";
  const Folder folder;
  const std::string pty = folder / "twin", results = folder / "served";
  std::string program;
  for (const char* text : kLines) program += std::string(text) + "\n";
  program += "M30\n";
  const std::string file = folder.write("part.gcode", program);
  BackgroundRun server(
      folder,
      fmt::format(
          "serve --machine hexapod --dialect marlin --port pty:{} --speed 20 --gap-control off --out {}", pty,
          results));
  ASSERT_THAT(server.first_output(), HasSubstr("marlin"));
  const std::string sender = fmt::format(
      "(echo connect {} 115200; sleep 3; echo load {}; sleep 1; echo print; sleep 20) | HOME={} timeout 40 "
      "pronsole >{} 2>&1 &",
      pty, file, folder.path().string(), folder / "pronsole");
  ASSERT_EQ(std::system(sender.c_str()), 0);
  EXPECT_LE(server.wait(), 1) << read_file(folder / "pronsole");
  // Pronsole numbers lines, guards them by checksums, and asks for temperatures meanwhile.
  EXPECT_THAT(read_file(results + "/received.gcode"), HasSubstr("G1 X5 E0.4 F1200\nG1 Y5 E0.2\n"));
  EXPECT_TRUE(fs::exists(results + "/report.html"));
}

TEST(ServeCommand, AnAddressThatCannotBeUsedIsOneLineAndNothingWritten) {
  const Folder folder;
  const std::string out = " --out " + (folder / "served");
  for (const auto& [words, said] : {std::pair{"--port tcp:0.0.0.0:2323", "--network allows it"},
                                    std::pair{"--port usb:1", "tcp:HOST:PORT"},
                                    std::pair{"--port pty:/proc/twin", "--port pty:/proc/twin: "},
                                    std::pair{"--port tcp:127.0.0.1:1 --dialect klipper", "klipper"}}) {
    const Outcome outcome = understudy("serve --machine hexapod " + std::string(words) + out);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(said));
    EXPECT_FALSE(fs::exists(folder / "served"));
  }
}

}  // namespace
}  // namespace understudy::cli_test
