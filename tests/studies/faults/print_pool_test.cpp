#include "studies/faults/print_pool.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

PoolPrint made(const TemporaryFolder& folder, const std::string& machine, std::uint64_t seed,
               std::size_t number) {
  for (const char* below : {"programs", "machines"}) std::filesystem::create_directories(folder / below);
  return make_pool_print(machine, seed, number, folder.path());
}

TEST(ExtendedPrintPool, EqualSeedsMakeEqualPrints) {
  const TemporaryFolder one, same;
  for (const char* machine : {"hexapod", "five-axis"}) {
    const PoolPrint a = made(one, machine, 3, 0), b = made(same, machine, 3, 0);
    EXPECT_EQ(read_file(one / a.program), read_file(same / b.program));
    EXPECT_EQ(a.as_built, b.as_built);
    EXPECT_EQ(a.world, b.world);
    EXPECT_GT(a.duration, 0);
    EXPECT_LE(a.duration, 40);
    ASSERT_TRUE(a.intended);
    EXPECT_GT(a.intended->path(), 1e-3);
    EXPECT_GT(a.intended->filament(), 0);
  }
}

// The controller of such a machine has a calibrated file; the world is the one that the lab measured.
TEST(PrintPool, SomeMachinesAreBuiltAndCalibratedByALab) {
  const TemporaryFolder folder;
  int own = 0, of_shipped = 0;
  for (std::size_t number = 0; number < 6 && (own == 0 || of_shipped == 0); ++number) {
    const PoolPrint print = made(folder, "hexapod", 1, number);
    ++(print.own_machine ? own : of_shipped);
    EXPECT_EQ(print.world.has_value(), print.own_machine);
    if (!print.own_machine) continue;
    EXPECT_EQ(print.as_built, "manufactured");
    const auto machine = machine::load_machine((folder / print.machine_word).string());
    EXPECT_TRUE(machine.calibration);
    EXPECT_TRUE(machine.gap_sensor);
  }
  EXPECT_GT(own, 0);
  EXPECT_GT(of_shipped, 0);
}

}  // namespace
}  // namespace understudy::studies
