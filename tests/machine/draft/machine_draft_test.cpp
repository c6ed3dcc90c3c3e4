#include "machine/draft/machine_draft.h"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "machine/machine_notes.h"
#include "tests/machine/arm_with_shapes.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string put(const MachineDraft& draft, const TemporaryFolder& folder) {
  for (const DraftFile& file : draft.files) {
    fs::create_directories((folder / file.name).parent_path());
    write_file(folder / file.name, file.content);
  }
  write_file(folder / "machine.yaml", draft.text);
  return (folder / "machine.yaml").string();
}

/// Lines that hold a value and no comment.
std::vector<std::string> unexplained(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);)
    if (line.find(": ") != std::string::npos && line.find('#') == std::string::npos) lines.push_back(line);
  return lines;
}

class DraftOfKind : public testing::TestWithParam<std::string> {};

TEST_P(DraftOfKind, LoadsAsTheMachineItIsLikeUnderItsOwnName) {
  const TemporaryFolder folder;
  const MachineDraft draft = draft_of_kind(GetParam(), "my machine");
  const std::string file = put(draft, folder);
  const MachineDescription mine = load_machine(file), ready = load_machine(GetParam());
  EXPECT_EQ(mine.name, "my machine");
  EXPECT_EQ(mine.X_BT_home.matrix(), ready.X_BT_home.matrix());
  EXPECT_EQ(mine.X_WB.matrix(), ready.X_WB.matrix());
  EXPECT_EQ(mine.tool.bodies.size(), ready.tool.bodies.size());
  EXPECT_EQ(mine.drives[0].lead, ready.drives[0].lead);
  EXPECT_THAT(load_machine_notes(file).assumed, Contains("tolerances"));
  EXPECT_THAT(unexplained(draft.text), IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(EveryReadyMachine, DraftOfKind, testing::ValuesIn(machine_names()),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(MachineDraft, AnUnknownKindNamesTheNearest) {
  try {
    draft_of_kind("five-axes", "mine");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("unknown kind 'five-axes', did you mean 'five-axis'?"));
  }
}

TEST(MachineDraft, OfAUrdfStandsUprightOverItsTable) {
  const TemporaryFolder folder;
  const fs::path urdf = fs::path(UNDERSTUDY_SOURCE_DIR) / "models/offset-wrist-arm/arm.urdf";
  const MachineDraft draft = draft_of_urdf({"mine", urdf, "", "", "", ""});
  EXPECT_EQ(draft.base_link, "base");
  EXPECT_EQ(draft.tool_link, "tool");
  EXPECT_EQ(draft.place_note, "");
  EXPECT_THAT(draft.assumed, ElementsAre("place", "home", "drives", "play", "tolerances", "tool", "motion"));
  EXPECT_THAT(unexplained(draft.text), IsEmpty());
  const MachineDescription machine = load_machine(put(draft, folder));
  const Pose home = machine.X_WB * machine.X_BT_home;
  // Rounded to tenths of a degree, which a metre of arm makes millimetres of.
  EXPECT_LT((home.translation() - Vec3(0, 0, 0.05)).norm(), 5e-3);
  EXPECT_NEAR(home.linear()(2, 2), 1, 1e-4);
}

TEST(MachineDraft, TakesTheMeshesAlongThatItFinds) {
  const TemporaryFolder from, to;
  write_arm_with_shapes(from.path(), "arms/meshes/fore.obj");
  const MachineDraft found = draft_of_urdf({"mine", from / "arm.urdf", "", "", "", ""});
  EXPECT_THAT(found.unchecked, IsEmpty());
  EXPECT_THAT(found.assumed, Contains("masses"));
  EXPECT_EQ(load_machine(put(found, to)).chain().links[1].bodies.size(), 2u);
  fs::remove_all(from / "arms");
  const MachineDraft missing = draft_of_urdf({"mine", from / "arm.urdf", "", "", "", ""});
  EXPECT_THAT(missing.unchecked, ElementsAre("fore"));
  const TemporaryFolder other;
  EXPECT_THAT(load_machine_notes(put(missing, other)).unchecked_links, ElementsAre("fore"));
}

}  // namespace
}  // namespace understudy::machine
