#include "calibration/bundle/sides_by_loads.h"

#include <cmath>

#include <gtest/gtest.h>

#include "calibration/machine/strut_sides.h"
#include "tests/calibration/bundle/drawn_bundle.h"

namespace understudy::calibration {
namespace {

constexpr double kPlay = 75e-6;  // [m]

DrawnBundle drawn_with_play() {
  DrawnSetting setting;
  setting.play = kPlay;
  DrawnBundle drawn = draw_bundle(setting, 5);
  BundleProblem& problem = drawn.problem;
  problem.unknowns.play = true;
  problem.nominal.play.fill(kPlay);
  problem.drives.play = 0.2 * kPlay;
  problem.drives.side_unknown = 0.5 * kPlay;
  for (BundlePose& pose : problem.poses)
    pose.approach =
        resting_sides(hexapod(), problem.nominal.geometry, hexapod().tolerances.manufactured, pose.X_BT);
  return drawn;
}

struct Sides {
  int known = 0, wrong = 0;
};

/// Against the loads on the true machine.
Sides counted(const DrawnBundle& drawn) {
  Sides sides;
  for (std::size_t j = 0; j < drawn.problem.poses.size(); ++j) {
    StrutLengths load;
    EXPECT_TRUE(strut_loads(hexapod(), drawn.truth.machine.geometry, drawn.truth.poses[j], load));
    for (std::size_t i = 0; i < kStruts; ++i) {
      const int side = static_cast<int>(drawn.problem.poses[j].approach[i]);
      sides.known += side != 0;
      sides.wrong += side * load[i] < 0;
    }
  }
  return sides;
}

TEST(SidesByLoads, AreTrueOnADrawingAndMoreOnTheMachineFound) {
  DrawnBundle drawn = drawn_with_play();
  const Sides drawing = counted(drawn);
  const BundleAdjustment found = adjust_bundle_by_loads(hexapod(), drawn.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  const Sides calibrated = counted(drawn);
  EXPECT_EQ(drawing.wrong, 0);
  EXPECT_EQ(calibrated.wrong, 0);
  EXPECT_GT(calibrated.known, drawing.known + 5);
  for (std::size_t i = 0; i < kStruts; ++i) {
    const Eigen::Index at = drawn.problem.unknowns.first_play() + static_cast<Eigen::Index>(i);
    const double sigma = std::sqrt(found.covariance(at, at));
    EXPECT_LT(sigma, 0.2 * kPlay) << i;  // of prior knowledge
    EXPECT_NEAR(found.state.machine.play[i], kPlay, 4 * sigma) << i;
  }
}

TEST(SidesByLoads, ThatWereToldStay) {
  DrawnBundle drawn = drawn_with_play();
  for (BundlePose& pose : drawn.problem.poses) pose.approach.fill(Approach::lengthening);
  const BundleAdjustment found = adjust_bundle_by_loads(hexapod(), drawn.problem);
  EXPECT_TRUE(found.ok()) << found.message;
  for (const BundlePose& pose : drawn.problem.poses)
    for (const Approach side : pose.approach) EXPECT_EQ(side, Approach::lengthening);
}

}  // namespace
}  // namespace understudy::calibration
