#include "machine/optics_mounting.h"

#include <gtest/gtest.h>

namespace understudy::machine {
namespace {

OpticsMounting drawn() { return mounting_of(load_machine("hexapod")); }

MountingVector one(int index, double value) {
  MountingVector error = MountingVector::Zero();
  error[index] = value;
  return error;
}

TEST(OpticsMounting, EachFreedomMovesOneDeviceInItsOwnFrame) {
  const OpticsMounting from = drawn();
  EXPECT_TRUE(moved(from, MountingVector::Zero()).X_TC.isApprox(from.X_TC, 1e-15));
  const OpticsMounting laser = moved(from, one(1, 1e-4));
  EXPECT_TRUE(
      (laser.X_TL.translation() - from.X_TL.translation()).isApprox(1e-4 * from.X_TL.linear().col(1), 1e-9));
  EXPECT_TRUE(laser.X_TC.isApprox(from.X_TC, 1e-15));
  const OpticsMounting leaning = moved(from, one(2, 1e-3));  // about x: z leans towards -y
  EXPECT_NEAR(leaning.X_TL.linear().col(2).dot(from.X_TL.linear().col(1)), -1e-3, 1e-9);
  EXPECT_EQ(leaning.X_TL.translation(), from.X_TL.translation());
  const OpticsMounting camera = moved(from, one(6, 1e-4));
  EXPECT_TRUE(
      (camera.X_TC.translation() - from.X_TC.translation()).isApprox(1e-4 * from.X_TC.linear().col(2), 1e-9));
  const OpticsMounting rolled = moved(from, one(9, 1e-3));
  EXPECT_NEAR(rolled.X_TC.linear().col(0).dot(from.X_TC.linear().col(1)), 1e-3, 1e-9);
  EXPECT_NEAR(moved(from, one(10, 5e-3)).focal_px, 1.005 * from.focal_px, 1e-9);
}

TEST(OpticsMounting, ToleranceAndUnitOfEachFreedomAreOfItsKind) {
  const MountingVector sigmas = mounting_sigmas({0.1e-3, 2e-3, 5e-3});
  for (int i = 0; i < kMountingFreedoms; ++i) {
    double si = 0;
    const std::string unit = mounting_report_unit(i, si);
    EXPECT_EQ(sigmas[i], unit == "um" ? 0.1e-3 : unit == "mrad" ? 2e-3 : 5e-3) << mounting_freedom(i);
    EXPECT_EQ(mounting_file_unit(i), unit == "um" ? 1e-3 : 1) << mounting_freedom(i);
    EXPECT_EQ(si, unit == "um" ? 1e-6 : 1e-3);
  }
  EXPECT_STREQ(mounting_freedom(6), "camera offset z");
}

TEST(OpticsMounting, ThePictureHasTheScaleOfItsDescriptionWhereTheBeamCrossesTheTipPlane) {
  EXPECT_NEAR(picture_scale(load_machine("hexapod")), 64e3, 1e-6);
}

}  // namespace
}  // namespace understudy::machine
