#include "tests/temporary_folder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace understudy {
namespace {

// A test with a parameter has a name with a slash.
class TemporaryFolderTest : public testing::TestWithParam<const char*> {};

TEST_P(TemporaryFolderTest, LeavesNothingBehind) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    std::ofstream(folder / "written") << "by the test";
    ASSERT_TRUE(std::filesystem::is_regular_file(path / "written"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::equivalent(path.parent_path(), testing::TempDir()));
}

INSTANTIATE_TEST_SUITE_P(Named, TemporaryFolderTest, testing::Values("parameter"));

}  // namespace
}  // namespace understudy
