#include "core/file/output_file.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;

class OutputFile : public ::testing::Test {
 protected:
  TemporaryFolder root_;
};

TEST_F(OutputFile, AFailedWriteLeavesTheOldFile) {
  write_file(root_ / "a", "old");
  fs::create_directory(root_ / "d");
  EXPECT_THROW(write_file(root_ / "missing" / "a", "new"), MachineError);
  EXPECT_THROW(write_file(root_ / "d", "new"), MachineError);
  EXPECT_EQ(read_file(root_ / "a"), "old");
  EXPECT_EQ(root_.entries(), 2);
}

TEST_F(OutputFile, AFullDiskIsNoBadInput) {
  EXPECT_THROW(write_file("/dev/full", "x"), MachineError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(OutputFile, LinksAndDevicesStayWhatTheyAre) {
  write_file(root_ / "a", "old");
  fs::create_symlink("a", root_ / "link");
  write_file(root_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(root_ / "link"));
  EXPECT_EQ(read_file(root_ / "a"), "new");
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFile, WhatCannotBeWrittenIsToldBeforeTheWork) {
  write_file(root_ / "a", "old");
  fs::create_directory(root_ / "d");
  fs::create_symlink("missing/b", root_ / "link");
  fs::create_symlink("loop", root_ / "loop");
  const fs::path wrong[] = {root_ / "missing" / "b",
                            root_ / "d",
                            root_ / "d" / "",
                            root_ / "a" / "b",
                            root_ / "link",
                            root_ / "loop",
                            root_ / std::string(256, 'n'),
                            ""};
  for (const auto& path : wrong) EXPECT_THROW(check_writable(path), InputError) << path;
  fs::create_symlink("d/new", root_ / "to a new one");
  const fs::path right[] = {root_ / "a", root_ / "new", root_ / std::string(255, 'n'), root_ / "to a new one",
                            "/dev/null"};
  for (const auto& path : right) EXPECT_NO_THROW(check_writable(path)) << path;
  EXPECT_EQ(read_file(root_ / "a"), "old");
}

}  // namespace
}  // namespace understudy
