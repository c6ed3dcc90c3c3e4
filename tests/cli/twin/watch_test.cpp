// `--watch` of `rehearse`, `serve` and `drive` as a browser meets it.
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <regex>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#undef _res  // a macro of <resolv.h>, which httplib includes; Eigen has parameters of that name

#include "core/file/descriptor.h"
#include "core/file/read_file.h"
#include "machine/record/record_reader.h"
#include "tests/cli/background_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;

const std::string kRehearse = UNDERSTUDY_SOURCE_DIR "/scenarios/song-bottle.gcode --fixture bottle";

int port_of(const std::string& said) {
  std::smatch found;
  return std::regex_search(said, found, std::regex("watch: http://127\\.0\\.0\\.1:(\\d+)/"))
             ? std::stoi(found[1])
             : 0;
}

/// A rehearsal of the bottle that is watched.
struct Watched {
  Watched() : run(folder, fmt::format("rehearse {} --watch --out {}", kRehearse, out)) {
    port = port_of(run.first_error_output());
  }
  Folder folder;
  std::string out = folder / "results";
  BackgroundRun run;
  int port = 0;  ///< 0: it told none
};

/// All of /events until the server ends them.
std::string events_of(httplib::Client& client) {
  std::string heard;
  client.Get("/events", [&](const char* data, std::size_t size) {
    heard.append(data, size);
    return true;
  });
  return heard;
}

TEST(WatchCommand, ShowsTheRunWhileItGoesAndTheReportAtItsEnd) {
  Watched watched;
  ASSERT_GT(watched.port, 0);
  httplib::Client client("127.0.0.1", watched.port);
  client.set_read_timeout(120);

  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_THAT(page->body, HasSubstr("\"live\":{\"share\":"));

  const std::string events = events_of(client);
  EXPECT_THAT(events, HasSubstr("event: grown\ndata: {\"share\":"));
  EXPECT_THAT(events, HasSubstr("printing"));
  EXPECT_THAT(events, HasSubstr("event: done"));

  const auto last = client.Get("/");
  ASSERT_TRUE(last) << "the command waits for who watches";
  EXPECT_LE(watched.run.wait(), 1) << "a verdict, whichever";
  EXPECT_EQ(last->body, read_file(watched.out + "/report.html"));
}

TEST(WatchCommand, ItsDataAreThoseOfTheReportUpToNow) {
  const Watched watched;
  ASSERT_GT(watched.port, 0);
  httplib::Client client("127.0.0.1", watched.port);
  double latest = -1;
  for (int looked = 0; looked < 1000; ++looked) {
    const auto record = client.Get("/record.json");
    if (!record || record->status != 200) break;
    const auto report = nlohmann::json::parse(record->body);
    EXPECT_EQ(report.at("schema"), "understudy.report/1");
    if (!report.contains("trace")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    const auto& columns = report.at("trace").at("columns");
    EXPECT_GE(columns.at("time_s").back().get<double>(), latest);
    latest = columns.at("time_s").back().get<double>();
    EXPECT_TRUE(columns.contains("gap_mm") && columns.contains("l6_mm"));
    if (latest > 1) break;
  }
  EXPECT_GT(latest, 1) << "of the print's own seconds";
}

TEST(WatchCommand, AnswersThisComputersNamesOnly) {
  Watched watched;
  ASSERT_GT(watched.port, 0);
  httplib::Client client("127.0.0.1", watched.port);
  const auto answer = client.Get("/record.json", {{"Host", fmt::format("example.org:{}", watched.port)}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 403);
  EXPECT_TRUE(answer->body.empty());

  // A body would be read whole, however large.
  const auto posted = client.Post("/", std::string(1000, 'x'), "text/plain");
  ASSERT_TRUE(posted);
  EXPECT_EQ(posted->status, 405);

  const Outcome second = understudy(fmt::format("rehearse {} --watch --watch-port {} --out {}", kRehearse,
                                                watched.port, watched.folder / "b"));
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, HasSubstr(fmt::format("--watch-port {}: the port is in use", watched.port)));

  watched.run.interrupt();
  EXPECT_EQ(watched.run.wait(), 128 + 2);
}

/// Says a line to a controller and waits for its answer.
void say(int file, const std::string& line) {
  const std::string text = line + "\n";
  ASSERT_EQ(::write(file, text.data(), text.size()), std::ssize(text));
  std::string heard;
  while (heard.find("ok") == std::string::npos) {
    pollfd look{file, POLLIN, 0};
    ASSERT_GT(::poll(&look, 1, 60'000), 0) << line;
    char bytes[256];
    const ssize_t count = ::read(file, bytes, sizeof bytes);
    ASSERT_GT(count, 0) << line;
    heard.append(bytes, static_cast<std::size_t>(count));
  }
}

/// Data of the page once `ready` of them; of a command that goes on meanwhile.
nlohmann::json record_when(httplib::Client& client, const std::function<bool(const nlohmann::json&)>& ready) {
  for (int looked = 0; looked < 3000; ++looked) {
    const auto record = client.Get("/record.json");
    if (!record || record->status != 200) break;
    const auto report = nlohmann::json::parse(record->body);
    if (ready(report)) return report;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return {};
}

TEST(ExtendedWatchCommand, ServeShowsWhatTheSenderIsToldAndThenTheRehearsal) {
  const Folder folder;
  const std::string pty = folder / "twin", results = folder / "served";
  BackgroundRun server(folder, fmt::format("serve --machine hexapod --port pty:{} --dialect marlin --speed 2 "
                                           "--gap-control off --watch --out {}",
                                           pty, results));
  const int port = port_of(server.first_error_output());
  ASSERT_GT(port, 0);
  ASSERT_THAT(server.first_output(), HasSubstr("listens"));
  httplib::Client client("127.0.0.1", port);
  client.set_read_timeout(120);
  EXPECT_EQ(record_when(client, [](const auto&) { return true; }).at("live").at("what"),
            "waiting for a sender");
  {
    const Descriptor line(::open(pty.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    ASSERT_GE(line.get(), 0);
    for (const char* text : {"M83", "M104 S210", "G0 X-5 Y0 Z50 F3000", "G1 X5 E0.4 F120"})
      say(line.get(), text);
    // 10 mm at 2 mm/s, told twice as fast: half of it is there after 1.25 s.
    const auto report = record_when(client, [](const nlohmann::json& now) {
      return now.contains("trace") && now["trace"]["columns"]["path_mm"].back() > 5.0;
    });
    ASSERT_FALSE(report.is_null());
    EXPECT_EQ(report.at("title"), "received.gcode on hexapod");
    EXPECT_EQ(report.at("live").at("what"), "receiving: 2 moves, 0 lines refused");
    const auto& columns = report.at("trace").at("columns");
    EXPECT_NEAR(columns.at("x_mm").back().get<double>(), columns.at("path_mm").back().get<double>() - 5,
                0.05);
    EXPECT_FALSE(columns.contains("gap_mm") || columns.contains("tip_error_um")) << "nobody knows them";
    say(line.get(), "M400");
    say(line.get(), "M30");
  }
  const std::string events = events_of(client);
  EXPECT_THAT(events, HasSubstr("event: done"));
  const auto last = client.Get("/");
  ASSERT_TRUE(last);
  EXPECT_LE(server.wait(), 1);
  EXPECT_EQ(last->body, read_file(results + "/report.html"));
}

/// Times and first axes of all setpoints and states of a record, in its order.
std::vector<std::pair<double, double>> recorded(const std::string& file) {
  std::vector<std::pair<double, double>> all;
  machine::read_record(file, [&](const machine::RecordedEntry& entry) {
    if (const auto* submit = std::get_if<machine::RecordedSubmit>(&entry))
      for (const machine::Setpoint& each : submit->setpoints) all.emplace_back(each.time, each.position[0]);
    if (const auto* state = std::get_if<machine::AxisState>(&entry))
      all.emplace_back(state->time, state->position[0]);
  });
  return all;
}

TEST(ExtendedWatchCommand, DriveShowsTheAxesAndItsRecordIsTheSame) {
  const Folder folder;
  std::string program = "G21 G90 M83\nG0 X-20 Y0 Z60\n";
  for (int line = 0; line < 150; ++line)  // of 40 mm at 10 mm/s: ten minutes of the machine's clock
    program += fmt::format("G1 X{} Y{:.2f} E1.2 F600\n", line % 2 == 0 ? 20 : -20, 0.02 * line);
  const std::string words = "drive " + folder.write("long.gcode", program) +
                            " --port loopback:// --without-rehearsal --gap-control off --record ";
  BackgroundRun watched(folder, words + (folder / "watched.record") + " --watch");
  const int port = port_of(watched.first_error_output());
  ASSERT_GT(port, 0);
  httplib::Client client("127.0.0.1", port);
  client.set_read_timeout(120);
  const std::string events = events_of(client);
  EXPECT_THAT(events, HasSubstr("\"what\":\"printing\""));
  EXPECT_THAT(events, HasSubstr("event: ended\ndata: {\"what\":\"The print is complete.\"}"));
  EXPECT_EQ(watched.wait(), 0);
  ASSERT_EQ(understudy(words + (folder / "alone.record")).status, 0);
  const auto seen = recorded(folder / "watched.record");
  EXPECT_GT(seen.size(), 1000U);
  EXPECT_EQ(seen, recorded(folder / "alone.record"));
}

}  // namespace
}  // namespace understudy::cli_test
