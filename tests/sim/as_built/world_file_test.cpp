// Drives, sensors, part and filament in as-built files: what is written reads back, mistakes have a line.
#include "sim/as_built/world_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "sim/as_built/as_built_file.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class WorldFile : public testing::Test {
 protected:
  AsBuilt read(const std::string& text) {
    write_file(path_, text);
    return make_as_built(hexapod_, path_, 1);
  }
  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  const machine::MachineDescription hexapod_ = machine::load_machine("hexapod");
  const TemporaryFolder folder_;
  const std::string path_ = (folder_ / "world.yaml").string();
};

// Units are divided out and multiplied in again, and a rotation passes through a quaternion: some roundings.
constexpr double kRounding = 4e-15;

TEST_F(WorldFile, AManufacturedMachineReadsBackAsTheSame) {
  const AsBuilt built = make_as_built(hexapod_, "manufactured", 11), back = read(write_as_built(built));
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_NEAR(back.drives[i].scale, built.drives[i].scale, kRounding);
    EXPECT_NEAR(back.drives[i].periodic, built.drives[i].periodic, kRounding);
    EXPECT_NEAR(back.drives[i].phase, built.drives[i].phase, kRounding);
    EXPECT_NE(built.drives[i].scale, 0);
  }
  EXPECT_TRUE(back.laser.X_TL.isApprox(built.laser.X_TL, kRounding));
  EXPECT_TRUE(back.microscope.X_TC.isApprox(built.microscope.X_TC, kRounding));
  EXPECT_TRUE(back.part.X_WF.isApprox(built.part.X_WF, kRounding));
  EXPECT_DOUBLE_EQ(back.laser.peak_level, built.laser.peak_level);
  EXPECT_DOUBLE_EQ(back.laser.waist_diameter, built.laser.waist_diameter);
  EXPECT_DOUBLE_EQ(back.microscope.camera.focal_px, built.microscope.camera.focal_px);
  EXPECT_EQ(back.microscope.camera.centre_px, built.microscope.camera.centre_px);
  EXPECT_EQ(back.microscope.camera.k1, built.microscope.camera.k1);
  EXPECT_NE(built.microscope.camera.k1, 0);
  EXPECT_DOUBLE_EQ(back.microscope.blur_px, built.microscope.blur_px);
  EXPECT_DOUBLE_EQ(back.microscope.ambient_level, built.microscope.ambient_level);
  EXPECT_DOUBLE_EQ(back.part.size, built.part.size);
  EXPECT_NEAR(back.part.ripple, built.part.ripple, kRounding);
  EXPECT_NEAR(back.part.phase, built.part.phase, kRounding);
  EXPECT_DOUBLE_EQ(back.filament_diameter, built.filament_diameter);
  EXPECT_DOUBLE_EQ(back.extruder_lag, built.extruder_lag);
  EXPECT_DOUBLE_EQ(back.nozzle_offset, built.nozzle_offset);
}

TEST_F(WorldFile, OmittedValuesAreThoseOfTheDrawing) {
  const AsBuilt built = read("laser: {peak_levels: 150}\npart: {position_mm: [0.1, 0, 0.2]}\n");
  EXPECT_DOUBLE_EQ(built.laser.peak_level, 150);
  EXPECT_EQ(built.laser.X_TL.matrix(), hexapod_.laser.X_TL.matrix());
  EXPECT_EQ(built.part.X_WF.linear(), Mat3::Identity());
  EXPECT_DOUBLE_EQ(built.part.X_WF.translation().z(), 0.2e-3);
  EXPECT_EQ(built.filament_diameter, hexapod_.tool.filament_diameter);
}

TEST_F(WorldFile, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(error_of("deviation_mm: 15\nlaser: {peak_level: 150}\n"),
              AllOf(HasSubstr("/world.yaml:2"), HasSubstr("laser.peak_level"), HasSubstr("peak_levels")));
  EXPECT_THAT(
      error_of("camera: {quaternion: [1, 0, 0, 0.1]}\n"),
      AllOf(HasSubstr("/world.yaml:1"), HasSubstr("camera.quaternion has length 1.00"), HasSubstr("not 1")));
  EXPECT_THAT(error_of("drives:\n  - {drive: 2}\n  - {drive: 2}\n"),
              AllOf(HasSubstr("/world.yaml:3"), HasSubstr("told before")));
  EXPECT_THAT(error_of("part: {size: 3}\n"), AllOf(HasSubstr("part.size"), HasSubstr("0.5 to 2")));
}

TEST_F(WorldFile, OfAMachineThatSeesNothingHasNoLaser) {
  const auto finishing = machine::load_machine("finishing");
  write_file(path_, "laser: {peak_levels: 150}\n");
  EXPECT_THROW(make_as_built(finishing, path_, 1), InputError);
  EXPECT_EQ(write_world(as_described(finishing)).find("laser"), std::string::npos);
}

}  // namespace
}  // namespace understudy::sim
