#include "core/file/read_file.h"

#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/interrupt.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ReadFile : public ::testing::Test {
 protected:
  static std::string refusal(const fs::path& path, std::size_t limit = kFileMax) {
    try {
      return "read: " + read_file(path, limit);
    } catch (const InputError& error) {
      return error.what();
    }
  }
  TemporaryFolder root_;
};

TEST_F(ReadFile, WhatIsNoFileIsNotRead) {
  EXPECT_THAT(refusal(root_ / "nothing"), HasSubstr("No such file"));
  EXPECT_THAT(refusal(root_.path()), HasSubstr("it is a folder"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("it is a device"));
  EXPECT_THAT(refusal("/proc/self/mem"), HasSubstr("Input/output error")) << "a read that fails is no end";
}

TEST_F(ReadFile, AFileLargerThanTheLimitIsNotRead) {
  write_file(root_ / "a", "12345678");
  EXPECT_EQ(refusal(root_ / "a", 8), "read: 12345678");
  EXPECT_THAT(refusal(root_ / "a", 7), HasSubstr("larger than"));
  std::ofstream(root_ / "sparse").close();
  fs::resize_file(root_ / "sparse", 214'000'000'000);
  EXPECT_THAT(refusal(root_ / "sparse"), HasSubstr("larger than 1000 MB"));
}

TEST_F(ReadFile, ABeginningTellsHowMuchIsBehindIt) {
  write_file(root_ / "a", "12345678");
  for (const std::size_t most : {0u, 5u, 8u, 9u}) {
    const FileBeginning beginning = read_beginning(root_ / "a", most);
    EXPECT_EQ(beginning.content, std::string("12345678").substr(0, most));
    EXPECT_EQ(beginning.left_out, most < 8 ? 8 - most : 0);
  }
  std::ofstream(root_ / "sparse").close();
  fs::resize_file(root_ / "sparse", 214'000'000'000);
  const FileBeginning beginning = read_beginning(root_ / "sparse", 100'000);
  EXPECT_EQ(beginning.content.size(), 100'000u) << "more than one piece";
  EXPECT_EQ(beginning.left_out, 213'999'900'000u);
  EXPECT_THROW(read_beginning(root_.path(), 1), InputError);
}

TEST_F(ReadFile, APipeIsReadAndAnInterruptEndsTheWait) {
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
