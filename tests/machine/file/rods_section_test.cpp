// Machines whose tool hangs on rods, in machine files.
#include "machine/file/rods_section.h"

#include <cmath>

#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string shipped() { return read_file(models_folder() / "delta" / "machine.yaml"); }

TEST(RodsSection, OfTheShippedMachineIsThatOfItsFile) {
  const MachineDescription m = load_machine("delta");
  const ChainModel& model = m.chain();
  ASSERT_EQ(model.kinematics.chain.rods.size(), 3u);
  for (const double rod : model.kinematics.chain.rods) EXPECT_DOUBLE_EQ(rod, 0.267);
  EXPECT_DOUBLE_EQ(model.rods.mass, 0.03);
  EXPECT_DOUBLE_EQ(model.rods.radius, 0.003);
  EXPECT_DOUBLE_EQ(model.rods.spacing, 0.046);
  EXPECT_DOUBLE_EQ(model.rods.tool_offset, 0.031);
  EXPECT_DOUBLE_EQ(model.rods.carried, 0.25);
  EXPECT_DOUBLE_EQ(m.tolerances.manufactured.rod_length, 0.2e-3);
  // Home is 100 mm over the middle, to the digits of the file.
  EXPECT_LE((m.X_BT_home.translation() - Vec3(0, 0, 0.1)).norm(), 0.05e-3);
  // A carriage moves the tip over the middle by 1/3 upwards and by 2/3 v/R across, v being the height of its
  // rod: three plays of 20 um.
  const double v = std::sqrt(0.267 * 0.267 - 0.1344 * 0.1344);
  EXPECT_NEAR(m.tip_play(), 3 * 20e-6 * std::hypot(1.0 / 3, 2.0 / 3 * v / 0.1344), 1e-9);
}

using RodsFile = EditedFile;

TEST_F(RodsFile, MissesItsSection) {
  EXPECT_THAT(error_of(edited(shipped(), "\nrods:", "rods:", "rodds:")), HasSubstr("'rods'"));
}

TEST_F(RodsFile, NamesABadValue) {
  EXPECT_THAT(error_of(edited(shipped(), "\nrods:", "pair_kg: 0.03", "pair_kg: -1")),
              AllOf(HasSubstr("rods.pair_kg"), HasSubstr(kInThatLine)));
}

// Carriages at one height, 232.8 mm apart: 20 and 267 mm do not span that.
TEST_F(RodsFile, WhoseRodsDoNotMeetAtHome) {
  EXPECT_THAT(error_of(edited(shipped(), "geometry:", "rod_a_mm: 267", "rod_a_mm: 20")),
              HasSubstr("geometry: the three rods do not meet with the axes at home"));
}

TEST_F(RodsFile, LacksAnAxis) {
  std::string text = shipped();
  const auto from = text.find("  - name: c"), to = text.find("\nrods:");
  EXPECT_THAT(error_of(text.erase(from, to - from)), HasSubstr("axes lists 2, 'delta' has 3"));
}

TEST_F(RodsFile, OfAnotherMachineAreUnknown) {
  std::string text = read_file(models_folder() / "corexy" / "machine.yaml");
  EXPECT_THAT(error_of(text + "\nrods: {pair_kg: 0.1}\n"), HasSubstr("'rods'"));
}

}  // namespace
}  // namespace understudy::machine
