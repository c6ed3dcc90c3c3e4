// A machine that names a URDF, written to another folder.
#include "machine/file/beside_machine.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "machine/description.h"
#include "machine/file/calibration_section.h"
#include "tests/machine/arm_with_shapes.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

TEST(BesideMachine, TheUrdfGoesWithTheMachine) {
  const TemporaryFolder folder;
  const MachineDescription drawn = load_machine("offset-wrist-arm");
  MachineDescription machine = drawn;
  machine.chain().kinematics.chain.X_OT_zero.translation().x() += 1e-3;
  machine.calibration = {"rows", "t.csv", std::string(64, '0'), 40, 30e-6};
  const auto path = folder / "calibrated.yaml";
  StagedFile staged = staged_with_section(machine.file, calibration_section(machine), path);
  std::optional<StagedFile> urdf = staged_urdf(machine.file, path);
  ASSERT_TRUE(urdf);
  EXPECT_EQ(folder.entries(), 2) << "both still under other names";
  urdf->commit();
  staged.commit();
  const MachineDescription back = load_machine(path.string());
  EXPECT_NEAR(back.chain().kinematics.chain.X_OT_zero.translation().x(),
              machine.chain().kinematics.chain.X_OT_zero.translation().x(), 1e-9);
  EXPECT_FALSE(staged_urdf(machine.file, path)) << "it is there already";
}

TEST(BesideMachine, MeshesAndSrdfGoWithTheUrdf) {
  const TemporaryFolder from, to;
  const std::string file =
      write_arm_with_shapes(from.path(), "arms/meshes/fore.obj", "  urdf:", "  srdf: arm.srdf\n  urdf:");
  write_file(from / "arm.srdf", "<robot name='shapes'/>");
  write_file(to / "m.yaml", read_file(file));
  EXPECT_THROW(load_machine((to / "m.yaml").string()), InputError);
  staged_urdf(file, to / "m.yaml")->commit();
  const auto companions = staged_companions(file, to / "m.yaml");
  EXPECT_EQ(companions.size(), 2u);
  for (const auto& companion : companions) companion->commit();
  EXPECT_EQ(load_machine((to / "m.yaml").string()).chain().links[1].bodies.size(), 2u);
  EXPECT_TRUE(staged_companions(file, to / "m.yaml").empty()) << "they are there already";
  EXPECT_TRUE(staged_companions(file, from / "m.yaml").empty());
}

TEST(BesideMachine, AnotherUrdfOfThatNameStays) {
  const TemporaryFolder folder;
  write_file(folder / "arm.urdf", "mine");
  EXPECT_THROW((void)staged_urdf(load_machine("offset-wrist-arm").file, folder / "m.yaml"), InputError);
  EXPECT_EQ(read_file(folder / "arm.urdf"), "mine");
}

TEST(BesideMachine, MostMachinesNameNone) {
  const TemporaryFolder folder;
  EXPECT_FALSE(staged_urdf(load_machine("arm").file, folder / "m.yaml"));
  EXPECT_FALSE(staged_urdf(load_machine("hexapod").file, folder / "m.yaml"));
}

}  // namespace
}  // namespace understudy::machine
