#include "core/output_file.h"

#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/interrupt.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(testing::TempDir()) /
            ("file-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  int entries() const { return static_cast<int>(std::distance(fs::directory_iterator(root_), {})); }
  static std::string refusal(const fs::path& path, std::size_t limit = kFileMax) {
    try {
      return "read: " + read_file(path, limit);
    } catch (const InputError& error) {
      return error.what();
    }
  }
  fs::path root_;
};

TEST_F(OutputFileTest, AFailedWriteLeavesTheOldFile) {
  write_file(root_ / "a", "old");
  fs::create_directory(root_ / "d");
  EXPECT_THROW(write_file(root_ / "missing" / "a", "new"), InputError);
  EXPECT_THROW(write_file(root_ / "d", "new"), InputError);
  EXPECT_EQ(read_file(root_ / "a"), "old");
  EXPECT_EQ(entries(), 2);
}

TEST_F(OutputFileTest, AFullDiskIsNoBadInput) {
  EXPECT_THROW(write_file("/dev/full", "x"), MachineError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(OutputFileTest, LinksAndDevicesStayWhatTheyAre) {
  write_file(root_ / "a", "old");
  fs::create_symlink("a", root_ / "link");
  write_file(root_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(root_ / "link"));
  EXPECT_EQ(read_file(root_ / "a"), "new");
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFileTest, WhatIsNoFileIsNotRead) {
  EXPECT_THAT(refusal(root_ / "nothing"), HasSubstr("No such file"));
  EXPECT_THAT(refusal(root_), HasSubstr("it is a folder"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("it is a device"));
  EXPECT_THAT(refusal("/proc/self/mem"), HasSubstr("Input/output error")) << "a read that fails is no end";
}

TEST_F(OutputFileTest, AFileLargerThanTheLimitIsNotRead) {
  write_file(root_ / "a", "12345678");
  EXPECT_EQ(refusal(root_ / "a", 8), "read: 12345678");
  EXPECT_THAT(refusal(root_ / "a", 7), HasSubstr("larger than"));
  std::ofstream(root_ / "sparse").close();
  fs::resize_file(root_ / "sparse", 214'000'000'000);
  EXPECT_THAT(refusal(root_ / "sparse"), HasSubstr("larger than 1000 MB"));
}

TEST_F(OutputFileTest, APipeIsReadAndAnInterruptEndsTheWait) {
  const fs::path pipe = root_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "G1 X1\n"; });
  EXPECT_EQ(read_file(pipe), "G1 X1\n");
  writer.join();

  std::thread user([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    set_interrupted(true);
  });
  EXPECT_THROW(read_file(pipe), Interrupted);
  user.join();
  set_interrupted(false);
}

}  // namespace
}  // namespace understudy
