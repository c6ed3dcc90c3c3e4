#include "core/file/scratch_folder.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"

namespace understudy {
namespace {

TEST(ScratchFolder, IsItsOwnAndGoesWithWhatIsInIt) {
  std::filesystem::path first;
  {
    const ScratchFolder one("test"), other("test");
    first = one.path();
    EXPECT_NE(one.path(), other.path());
    EXPECT_THAT(first.filename().string(), testing::StartsWith("understudy-test-"));
    write_file(first / "a", "content");
    EXPECT_EQ(read_file(first / "a"), "content");
  }
  EXPECT_FALSE(std::filesystem::exists(first));
}

TEST(ScratchFolder, SaysWhereItCannotBeMade) {
  ::setenv("TMPDIR", "/proc", 1);
  try {
    const ScratchFolder folder("test");
    FAIL() << folder.path();
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cannot make a folder in /proc"));
  }
  ::setenv("TMPDIR", "/nowhere/at/all", 1);
  EXPECT_THROW(ScratchFolder("test"), MachineError);
  ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace understudy
