#include "rehearsal/rehearse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A joint of the base 83 mm from its place: the hexapod stands at home, and is singular on the way to the
// line.
TEST(Rehearse, ABuiltMachineThatCannotFollowIsSaidOfItsFile) {
  const TemporaryFolder folder;
  RehearsalRequest request;
  request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  request.fixture = "bottle";
  request.engine = "quasistatic";
  request.gap_control = "off";
  request.keep_scene = false;
  request.as_built = (folder / "built.yaml").string();
  write_file(request.as_built, "struts:\n  - {strut: 1, base_joint_mm: [-8.7, 4, 0.1]}\n");
  try {
    rehearse(request);
    FAIL() << "no error";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(),
                AllOf(StartsWith(request.as_built + ": "), HasSubstr(" s: the loops cannot be closed")));
  }
}

}  // namespace
}  // namespace understudy::rehearsal
