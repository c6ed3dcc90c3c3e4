#include "calibration/machine/tip_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::calibration {
namespace {

TEST(TipMap, AMachineThatReachesNoneOfItsWorkSpaceIsNoResultOfMeasurements) {
  const machine::MachineDescription drawn = machine::load_machine("hexapod");
  machine::MachineDescription found = drawn;
  for (double& offset : found.hexapod().geometry.length_offset)
    offset += 0.1;  // struts that long stay folded
  for (Vec3& joint : found.hexapod().geometry.base_joint) joint.z() += 0.3;
  try {
    tip_map(drawn, found, {});
    FAIL() << "it reaches some";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("reaches hardly any pose of its work space"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--estimator robust"));
  }
}

TEST(TipMap, AShiftOfAllBaseJointsMovesEveryTipByIt) {
  const machine::MachineDescription drawn = machine::load_machine("hexapod");
  machine::MachineDescription found = drawn;
  for (Vec3& joint : found.hexapod().geometry.base_joint) joint.x() += 0.3e-3;
  const TipMap map = tip_map(drawn, found, {});
  EXPECT_NEAR(map.moved_median, 0.3e-3, 1e-9);  // the solver stops at 1e-12 of a length
  EXPECT_NEAR(map.moved_worst, 0.3e-3, 1e-9);
  EXPECT_EQ(map.poses, 0) << "no covariance was given";
}

}  // namespace
}  // namespace understudy::calibration
