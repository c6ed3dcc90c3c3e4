#include "core/file/outside.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;

TEST(Outside, LinksAndDotsAreFollowed) {
  const TemporaryFolder root;
  fs::create_directories(root / "machine" / "parts");
  write_file(root / "secret", "x");
  fs::create_symlink(root / "secret", root / "machine" / "link");
  fs::create_symlink("parts", root / "machine" / "inner");
  const fs::path folder = root / "machine";
  for (const char* name : {"arm.urdf", "parts/arm.urdf", "./arm.urdf", "parts/../arm.urdf", "inner/arm.urdf"})
    EXPECT_TRUE(may_be_named_from(folder, folder / name)) << name;
  for (const char* name : {"../secret", "/etc/passwd", "parts/../../secret", "link", "../machine-2/arm.urdf"})
    EXPECT_FALSE(may_be_named_from(folder, folder / name)) << name;
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  EXPECT_TRUE(may_be_named_from("", "arm.urdf"));
  EXPECT_FALSE(may_be_named_from("", "../secret"));
  fs::current_path(before);
}

TEST(Outside, TheUserMayAllowIt) {
  ::setenv(kAllowOutside, "0", 1);
  EXPECT_FALSE(may_be_named_from("a", "b"));
  ::setenv(kAllowOutside, "1", 1);
  EXPECT_TRUE(may_be_named_from("a", "b"));
  ::unsetenv(kAllowOutside);
}

}  // namespace
}  // namespace understudy
