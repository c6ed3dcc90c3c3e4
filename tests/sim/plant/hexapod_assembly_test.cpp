#include "sim/plant/hexapod_assembly.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string error_of(const machine::MachineDescription& machine, const AsBuilt& built) {
  try {
    check_stands_at_home(machine, built);
  } catch (const InputError& error) {
    return error.what();
  }
  return "stands";
}

TEST(HexapodAssembly, AMachineAsDescribedStandsAtHome) {
  const auto machine = machine_g4();
  const AsBuilt built = as_described(machine);
  const Pose X_WT = assemble_hexapod(machine, built, home_displacement(machine, built));
  EXPECT_LT((X_WT.translation() - (machine.X_WB * machine.X_BT_home).translation()).norm(), 1e-9);
  EXPECT_EQ(error_of(machine, built), "stands");
}

TEST(HexapodAssembly, EveryMachineAsManufacturedStandsAtHome) {
  const auto machine = machine_g4();
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    EXPECT_EQ(error_of(machine, make_as_built(machine, "manufactured", seed)), "stands") << seed;
}

TEST(HexapodAssembly, AStrutThatIsFarTooShortIsSaidOfTheAsBuiltFile) {
  const TemporaryFolder folder;
  const std::string file = (folder / "built.yaml").string();
  write_file(file, "struts:\n  - {strut: 4, length_offset_mm: 17.0}\n");  // 170 was meant
  const auto machine = machine_g4();
  EXPECT_THAT(error_of(machine, make_as_built(machine, file, 1)),
              AllOf(StartsWith(file + ": "), HasSubstr("home"), HasSubstr("the loops cannot be closed")));
}

TEST(HexapodAssembly, AnyChainStands) {
  const auto machine = machine::load_machine("arm");
  EXPECT_EQ(error_of(machine, make_as_built(machine, "manufactured", 1)), "stands");
}

}  // namespace
}  // namespace understudy::sim
