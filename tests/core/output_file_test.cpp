#include "core/output_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ =
        fs::temp_directory_path() /
        ("understudy-output-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  int entries() const { return static_cast<int>(std::distance(fs::directory_iterator(root_), {})); }
  fs::path root_;
};

TEST_F(OutputFolderTest, WithoutCommitNothingRemains) {
  {
    OutputFolder folder(root_ / "out", "summary.json");
    write_file(folder.path() / "summary.json", "{}");
    EXPECT_FALSE(fs::exists(root_ / "out"));
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(OutputFolderTest, CommitReplacesAnOlderResultWhole) {
  for (const char* name : {"first", "second"}) {
    OutputFolder folder(root_ / "out", "summary.json");
    write_file(folder.path() / "summary.json", name);
    write_file(folder.path() / name, "x");
    folder.commit();
  }
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_FALSE(fs::exists(root_ / "out" / "first"));
  EXPECT_EQ(entries(), 1);
}

TEST_F(OutputFolderTest, AForeignFolderIsNeverReplaced) {
  fs::create_directories(root_ / "photos");
  write_file(root_ / "photos" / "a.jpg", "precious");
  EXPECT_THROW(OutputFolder(root_ / "photos", "summary.json"), InputError);
  EXPECT_EQ(read_file(root_ / "photos" / "a.jpg"), "precious");
}

TEST_F(OutputFolderTest, AFolderThatCannotBeMadeIsBadInput) {
  write_file(root_ / "file", "x");
  EXPECT_THROW(OutputFolder(root_ / "file" / "out", "summary.json"), InputError);
  EXPECT_THROW(OutputFolder("/proc/understudy", "summary.json"), InputError);
}

TEST_F(OutputFolderTest, AFailedWriteLeavesTheOldFile) {
  write_file(root_ / "a", "old");
  fs::create_directory(root_ / "d");
  EXPECT_THROW(write_file(root_ / "missing" / "a", "new"), InputError);
  EXPECT_THROW(write_file(root_ / "d", "new"), InputError);
  EXPECT_EQ(read_file(root_ / "a"), "old");
  EXPECT_EQ(entries(), 2);
  EXPECT_THROW(read_file(root_ / "nothing"), InputError);
  EXPECT_THROW(read_file(root_ / "d"), InputError);
}

}  // namespace
}  // namespace understudy
