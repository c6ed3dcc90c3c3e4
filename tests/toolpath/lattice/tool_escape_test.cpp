#include "toolpath/lattice/tool_escape.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kMargin = 0.1e-3, kLift = 2e-3;

// A nozzle, and a block that is wider than it is far up.
std::vector<geometry::Shape> tool_bodies() {
  const auto above = [](double z) { return make_pose(Quat::Identity(), Vec3(0, 0, z)); };
  return {{"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()},
          {"block", geometry::Cylinder{20e-3, 10e-3}, above(17e-3)}};
}

// Independent of the planner: how deep a point is in the bodies as they are told above.
double depth(const Vec3& p_T) {
  const double rho = p_T.head<2>().norm(), z = p_T.z();
  double deepest = -1;
  if (z >= 0 && z <= 12e-3) deepest = std::max(deepest, 0.5e-3 + 3e-3 * z / 12e-3 - rho);
  if (z >= 12e-3 && z <= 22e-3) deepest = std::max(deepest, 20e-3 - rho);
  return deepest;
}

bool takes_all(const std::vector<Pose>&) { return true; }

Vec3 leaning(double degrees) { return {std::sin(from_deg(degrees)), 0, std::cos(from_deg(degrees))}; }

TEST(ToolEscape, AnUprightToolGoesStraightUpAboveTheHighestStrut) {
  const ToolEnvelope tool(tool_bodies());
  const ToolEscape escape(tool, kMargin, kLift);
  const std::vector<StrutBody> built = {{Vec3(0.05, 0, 0), Vec3(0.05, 0, 30e-3), 0.24e-3}};
  const auto way = escape.find(Vec3(0, 0, 5e-3), Vec3::UnitZ(), built, takes_all);
  ASSERT_TRUE(way);
  ASSERT_EQ(way->size(), 2u);
  EXPECT_TRUE(way->back().translation().isApprox(Vec3(0, 0, 32.24e-3), 1e-12));  // 30 + 0.24 + 2
}

TEST(ToolEscape, NoPoseOnTheWayTouchesWhatIsBuilt) {
  const ToolEnvelope tool(tool_bodies());
  const ToolEscape escape(tool, kMargin, kLift);
  Random random(7, "posts");
  int rose = 0, turned_in_place = 0, went_on = 0;
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    std::vector<StrutBody> built;
    for (int k = 0; k < 6; ++k) {
      const Vec3 foot(-30e-3 * random.uniform(), 30e-3 * random.uniform(-1, 1), 0);
      built.push_back({foot, foot + Vec3(0, 0, 40e-3 * random.uniform()), 0.24e-3});
    }
    const Vec3 axis = leaning(random.uniform(15, 75));
    // Out of everything: beyond the plane across the axis.
    double level = 0;
    for (const StrutBody& b : built) level = std::max({level, axis.dot(b.from), axis.dot(b.to)});
    const Vec3 start = (level + kLift) * axis;
    // Every other machine cannot rise while its tool leans.
    const auto accept = [&](const std::vector<Pose>& way) {
      return trial % 2 == 0 || tool_axis(way[way.size() - 2]).z() > 1 - 1e-9;
    };
    const auto way = escape.find(start, axis, built, accept);
    if (!way) continue;
    rose += way->size() == 3 && !way->at(1).translation().isApprox(start, 1e-12);
    turned_in_place += way->at(1).translation().isApprox(start, 1e-12);
    went_on += way->size() > 3;
    EXPECT_TRUE(way->front().translation().isApprox(start, 1e-12));
    EXPECT_NEAR(tool_axis(way->back()).z(), 1, 1e-12);
    for (const StrutBody& b : built) EXPECT_GT(way->back().translation().z(), b.to.z() + 1.9e-3);
    for (std::size_t i = 1; i < way->size(); ++i)
      for (int k = 0; k <= 40; ++k) {
        const Pose X_TW = interpolate((*way)[i - 1], (*way)[i], k / 40.0).inverse();
        for (const StrutBody& b : built)
          for (int j = 0; j <= 40; ++j)
            ASSERT_LT(depth(X_TW * Vec3(b.from + (b.to - b.from) * j / 40)), -b.radius)
                << "pose " << i << " at " << k;
      }
  }
  EXPECT_GT(rose, 10);
  EXPECT_GT(turned_in_place, 10);
  EXPECT_GT(went_on, 10);
}

TEST(ToolEscape, TriesOtherWaysForAMachineThatCannotFollowTheFirst) {
  const ToolEnvelope tool(tool_bodies());
  const ToolEscape escape(tool, kMargin, kLift);
  const std::vector<StrutBody> built = {{Vec3(-0.05, 0, 0), Vec3(-0.05, 0, 30e-3), 0.24e-3}};
  int asked = 0;
  const auto second = [&](const std::vector<Pose>&) { return ++asked == 2; };
  const auto way = escape.find(Vec3(0, 0, 5e-3), leaning(30), built, second);
  ASSERT_TRUE(way);
  EXPECT_NEAR(way->back().translation().x(), -0.025, 1e-12);  // over the middle of post and start
  EXPECT_FALSE(escape.find(Vec3(0, 0, 5e-3), leaning(30), built, [](const auto&) { return false; }));
}

}  // namespace
}  // namespace understudy::toolpath
