// `rehearse --watch` as a browser meets it.
#include <chrono>
#include <regex>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
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

  const Outcome second = understudy(fmt::format("rehearse {} --watch --watch-port {} --out {}", kRehearse,
                                                watched.port, watched.folder / "b"));
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, HasSubstr(fmt::format("--watch-port {}: the port is in use", watched.port)));

  watched.run.interrupt();
  EXPECT_EQ(watched.run.wait(), 128 + 2);
}

}  // namespace
}  // namespace understudy::cli_test
