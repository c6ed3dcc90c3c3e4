#include "studies/campaign/result_store.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/complaint.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const StoreHeader kHeader{"aim", "abc", "1.2.3", {"machine.gap.aim_mm", "scenario.engine"}};

RunRow row(std::uint64_t index) {
  RunRow one;
  one.index = index;
  one.seed = 100 + index;
  one.scenario = "bottle, \"curved\"";
  one.values = {"0.13", "quasistatic"};
  one.end = index % 2 == 0 ? RunEnd::go : RunEnd::no_go;
  one.command = "understudy campaign a.yaml --only " + std::to_string(index);
  one.summary_sha256 = "ff";
  one.seconds = 1.5;
  one.metrics = {{"gap.start_mm", 0.131 + 1e-3 * static_cast<double>(index)}, {"findings.gap.count", 0.0}};
  return one;
}

class ResultStoreTest : public ::testing::Test {
 protected:
  std::filesystem::path path() const { return folder_.path() / "runs.sqlite"; }
  const TemporaryFolder folder_;
};

/// Of the file, by SQLite alone.
int run_sql(const std::filesystem::path& path, const char* sql) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  const int code = sqlite3_exec(database, sql, nullptr, nullptr, nullptr);
  sqlite3_close(database);
  return code;
}

TEST_F(ResultStoreTest, RowsComeBackAsTheyWerePut) {
  {
    ResultStore store(path(), kHeader);
    store.add(row(7));
    store.add(row(2));
  }
  const std::vector<RunRow> rows = read_rows(path(), kHeader);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].index, 2u);
  EXPECT_EQ(rows[1].scenario, row(7).scenario);
  EXPECT_EQ(rows[1].seed, 107u);
  EXPECT_EQ(rows[1].end, RunEnd::no_go);
  EXPECT_EQ(rows[1].values, row(7).values);
  EXPECT_EQ(rows[1].metrics, row(7).metrics);
  EXPECT_EQ(rows[1].summary_sha256, "ff");
  EXPECT_THAT(stored_runs(path(), kHeader), ElementsAre(2, 7));
}

TEST_F(ResultStoreTest, ARowThatIsThereStays) {
  ResultStore store(path(), kHeader);
  RunRow other = row(3);
  store.add(row(3));
  other.seconds = 99;
  store.add_all({other, row(4)});
  store = ResultStore(folder_.path() / "another.sqlite", kHeader);
  const std::vector<RunRow> rows = read_rows(path(), kHeader);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].seconds, 1.5);
}

TEST_F(ResultStoreTest, NobodyChangesOrDeletesARow) {
  ResultStore(path(), kHeader).add(row(1));
  EXPECT_EQ(run_sql(path(), "UPDATE runs SET seconds = 0"), SQLITE_CONSTRAINT);
  EXPECT_EQ(run_sql(path(), "DELETE FROM runs"), SQLITE_CONSTRAINT);
  EXPECT_EQ(read_rows(path(), kHeader)[0].seconds, 1.5);
}

TEST_F(ResultStoreTest, SurvivesThatItsWriterIsKilled) {
  const pid_t child = ::fork();
  if (child == 0) {
    ResultStore store(path(), kHeader);
    for (std::uint64_t i = 0; i < 50; ++i) store.add(row(i));
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(stored_runs(path(), kHeader).size(), 50u);
}

TEST_F(ResultStoreTest, IsRefusedWhileAnotherProcessWritesIt) {
  std::array<int, 2> ready{}, end{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  ASSERT_EQ(::pipe(end.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(end[1]);
    ResultStore store(path(), kHeader);
    char byte = 'x';
    static_cast<void>(!::write(ready[1], &byte, 1));
    static_cast<void>(!::read(end[0], &byte, 1));
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_TRUE(being_written(path()));
  EXPECT_THAT(complaint([&] { ResultStore(path(), kHeader); }),
              HasSubstr("another campaign is writing this result store"));
  ::close(end[1]);
  ::waitpid(child, nullptr, 0);
  EXPECT_FALSE(being_written(path()));
}

TEST_F(ResultStoreTest, AReaderThatKeepsItOpenKeepsNobodyFromMerging) {
  ResultStore(path(), kHeader, StoreUse::merged).add_all({row(1)});
  sqlite3* reader = nullptr;
  sqlite3_open(path().c_str(), &reader);
  ASSERT_EQ(sqlite3_exec(reader, "SELECT count(*) FROM runs", nullptr, nullptr, nullptr), SQLITE_OK);
  ResultStore(path(), kHeader, StoreUse::merged).add_all({row(2)});
  sqlite3_close(reader);
  EXPECT_THAT(stored_runs(path(), kHeader), ElementsAre(1, 2));
}

TEST_F(ResultStoreTest, AnotherVersionCampaignOrInputIsRefused) {
  ResultStore(path(), kHeader).add(row(1));
  StoreHeader other = kHeader;
  other.version = "1.2.4";
  EXPECT_THAT(complaint([&] { ResultStore(path(), other); }),
              HasSubstr("runs of understudy 1.2.3; this is 1.2.4"));
  other = kHeader;
  other.campaign = "other";
  EXPECT_THAT(complaint([&] { stored_runs(path(), other); }),
              HasSubstr("runs of the campaign 'aim', not of 'other'"));
  other = kHeader;
  other.inputs_sha256 = "def";
  EXPECT_THAT(complaint([&] { read_rows(path(), other); }), HasSubstr("was changed since"));
}

TEST_F(ResultStoreTest, AnotherSchemaVersionIsRefused) {
  ResultStore(path(), kHeader).add(row(1));
  ASSERT_EQ(run_sql(path(), "PRAGMA user_version = 2"), SQLITE_OK);
  EXPECT_THAT(complaint([&] { ResultStore(path(), kHeader); }),
              HasSubstr("a result store of schema version 2; this program reads version 1"));
}

TEST_F(ResultStoreTest, ADamagedStoreIsRefusedWithItsFile) {
  ResultStore(path(), kHeader).add(row(1));
  ASSERT_EQ(
      run_sql(
          path(),
          "INSERT INTO runs(run, scenario, seed, status, command, seconds) VALUES(9, 'b', 1, '', 'c', 1)"),
      SQLITE_OK);
  EXPECT_THAT(
      complaint([&] { read_rows(path(), kHeader); }),
      AllOf(StartsWith(path().string() + ": "), HasSubstr("run 9 is damaged: '' is no end of a run")));
  ASSERT_EQ(run_sql(path(), "ALTER TABLE runs RENAME COLUMN \"gap.start_mm\" TO \"gap.stbrt_mm\""),
            SQLITE_OK);
  EXPECT_THAT(complaint([&] { ResultStore(path(), kHeader); }),
              AllOf(StartsWith(path().string() + ": not a result store that can be read: "),
                    HasSubstr("gap.start_mm")));
}

TEST_F(ResultStoreTest, AQueryWithoutEndInPlaceOfTheRowsIsRefused) {
  ResultStore(path(), kHeader).add(row(1));
  ASSERT_EQ(run_sql(path(),
                    "ALTER TABLE runs RENAME TO kept; CREATE VIEW runs AS WITH RECURSIVE forever(n) AS "
                    "(SELECT 1 UNION ALL SELECT n + 1 FROM forever) SELECT kept.* FROM kept, forever"),
            SQLITE_OK);
  for (const auto& read : {std::function<void()>([&] { stored_runs(path(), kHeader); }),
                           std::function<void()>([&] { read_rows(path(), kHeader); })})
    EXPECT_THAT(complaint(read),
                AllOf(StartsWith(path().string() + ": "), HasSubstr("not a result store that can be read")));
}

TEST_F(ResultStoreTest, WhatIsNoStoreIsRefused) {
  std::ofstream(path()) << "run,go\n1,yes\nand enough text to be no empty file of SQLite, which has a header "
                           "of 100 bytes ......\n";
  EXPECT_THAT(complaint([&] { ResultStore(path(), kHeader); }),
              HasSubstr("not a result store that can be read"));
  const auto other = folder_.path() / "other.sqlite";
  ASSERT_EQ(run_sql(other, "CREATE TABLE photos(name TEXT)"), SQLITE_OK);
  EXPECT_THAT(complaint([&] { ResultStore(other, kHeader); }),
              HasSubstr("not the result store of a campaign"));
}

}  // namespace
}  // namespace understudy::studies
