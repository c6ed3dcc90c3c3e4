#include "core/file/file_cache.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/parallel.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

class CachedText : public testing::Test {
 protected:
  std::string text(const std::string& word) {
    return *cached<std::string>(word, [&] {
      ++reads_;
      return read_file(folder_ / word);
    });
  }
  void write(const std::string& word, const std::string& text) { write_file(folder_ / word, text); }
  int reads_ = 0;

 private:
  TemporaryFolder folder_;
};

TEST_F(CachedText, IsReadAgainWhereNobodyKeepsFiles) {
  write("a", "old");
  EXPECT_EQ(text("a"), "old");
  write("a", "new");
  EXPECT_EQ(text("a"), "new");
}

TEST_F(CachedText, IsReadOnceUntilTheLastKeeperGoes) {
  write("a", "old");
  {
    std::optional<FileCacheScope> first{std::in_place};
    EXPECT_EQ(text("a"), "old");
    const FileCacheScope second;
    first.reset();
    write("a", "new");
    EXPECT_EQ(text("a"), "old");
    EXPECT_EQ(reads_, 1);
  }
  EXPECT_EQ(text("a"), "new");
}

TEST_F(CachedText, IsToldByItsType) {
  const FileCacheScope keeper;
  write("1", "text");
  text("1");
  EXPECT_EQ(*cached<int>("1", [] { return 7; }), 7);
  EXPECT_EQ(text("1"), "text");
}

TEST_F(CachedText, IsNotKeptWhereItCouldNotBeRead) {
  const FileCacheScope keeper;
  EXPECT_THROW(text("a"), InputError);
  write("a", "there now");
  EXPECT_EQ(text("a"), "there now");
}

TEST_F(CachedText, MakesRoomForOthersWhenItWasAskedForLongestAgo) {
  const FileCacheScope keeper;
  for (std::size_t i = 0; i < FileCacheScope::kMost; ++i) {
    write(std::to_string(i), "");
    text(std::to_string(i));
  }
  text("0");
  write("one more", "");
  text("one more");  // in place of 1
  reads_ = 0;
  text("0");
  text("2");
  EXPECT_EQ(reads_, 0);
  text("1");
  EXPECT_EQ(reads_, 1);
}

TEST(CachedDigest, IsThatOfTheBytesThatWereRead) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  const std::string old = cached_sha256(folder / "a");
  const FileCacheScope keeper;
  EXPECT_EQ(cached_sha256(folder / "a"), old);
  write_file(folder / "a", "new");
  EXPECT_EQ(cached_sha256(folder / "a"), old);
}

TEST_F(CachedText, IsOneForAllThreads) {
  const FileCacheScope keeper;
  std::vector<std::shared_ptr<const int>> seen(100);
  in_parallel(seen.size(), 4, [&](std::size_t i) { seen[i] = cached<int>("a", [] { return 7; }); });
  for (const auto& value : seen) EXPECT_EQ(value, seen.front());
}

}  // namespace
}  // namespace understudy
