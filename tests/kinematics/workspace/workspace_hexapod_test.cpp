#include <gtest/gtest.h>

#include "kinematics/workspace/workspace.h"
#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {
namespace {

Workspace g4_workspace(double tilt_deg, double step_mm) {
  const auto geometry = nominal_g4();
  const auto mechanism =
      make_hexapod(geometry, joints_at_home(geometry, Pose::Identity()), limits_g4(), Pose::Identity());
  WorkspaceRequest request;
  request.grid = {Vec3::Constant(-0.050), Vec3::Constant(0.050), from_mm(step_mm)};
  request.orientations = {tilted(Vec3::Zero(), from_deg(tilt_deg), 0).linear()};  // about X
  request.spans = {{"strut", 0.070}, {"ball joint", from_deg(60)}};
  request.threads = 2;
  return evaluate_workspace(*mechanism, request);
}

// docs/reference.md#machine-g4 prints two digits, and tells no grid: 0.01 covers its rounding (0.005) and the
// share of points within half a step of the set's boundary that fall on the other side: from 5 to 2 mm, the
// fractions move by less than 0.0025.
constexpr std::array<std::pair<double, double>, 4> kFractions{{{0, .55}, {10, .51}, {20, .32}, {30, .10}}};

TEST(HexapodWorkspace, ReachesTheReferencesShareOfTheCube) {
  for (const auto& [tilt, fraction] : kFractions)
    EXPECT_NEAR(g4_workspace(tilt, 5).fraction(), fraction, 0.01) << "tilt " << tilt;
}

TEST(SlowHexapodWorkspace, AFinerGridTellsTheSame) {
  for (const auto& [tilt, fraction] : kFractions) {
    const double fine = g4_workspace(tilt, 2).fraction();
    EXPECT_NEAR(fine, fraction, 0.01) << "tilt " << tilt;
    EXPECT_NEAR(fine, g4_workspace(tilt, 5).fraction(), 0.0025) << "tilt " << tilt;
  }
}

TEST(HexapodWorkspace, StrutsBindUprightAndBallJointsWhenTilted) {
  // docs/reference.md#machine-g4: with and without joints the fractions hardly differ upright, and a tilt of
  // 30 deg spends the whole range of the ball joints.
  const Workspace upright = g4_workspace(0, 5), inclined = g4_workspace(30, 5);
  ASSERT_FALSE(upright.families.empty());
  EXPECT_EQ(upright.families.front().part, "strut");
  const auto share = [](const Workspace& w, const std::string& part) {
    std::int64_t broken = 0;
    for (const WorkspaceLimit& family : w.families)
      if (family.part == part) broken = std::max(broken, family.broken);
    return static_cast<double>(broken) / static_cast<double>(w.binding.size());
  };
  EXPECT_GT(share(inclined, "ball joint"), 2 * share(upright, "ball joint"));
}

}  // namespace
}  // namespace understudy::kinematics
