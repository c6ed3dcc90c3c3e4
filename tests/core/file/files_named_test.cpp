#include "core/file/files_named.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(FilesNamed, StarsStandForOtherCharactersInTheNameAlone) {
  const TemporaryFolder folder;
  const auto inside = folder / "a*[b";
  std::filesystem::create_directories(inside / "sub");
  for (const char* name : {"y.cfg", "x.cfg", "x.txt", "sub/z.cfg"}) write_file(inside / name, "");
  EXPECT_THAT(files_named(inside, "*.cfg"), ElementsAre(inside / "x.cfg", inside / "y.cfg"));
  EXPECT_THAT(files_named(inside, "x.???"), ElementsAre(inside / "x.cfg", inside / "x.txt"));
  EXPECT_THAT(files_named(inside, "*/z.cfg"), ElementsAre(inside / "sub/z.cfg"));
  EXPECT_THAT(files_named(inside, "none.cfg"), IsEmpty());
  EXPECT_THAT(files_named(folder.path(), "a*/x.txt"), ElementsAre(inside / "x.txt"));
}

}  // namespace
}  // namespace understudy
