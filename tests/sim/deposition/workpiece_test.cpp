#include "sim/deposition/workpiece.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "geometry/box_mesh.h"

namespace understudy::sim {
namespace {

// Coordinates to 60 mm are rounded to floats, 2 nm each; some of them are added, an axis leans on them.
constexpr double kFloat = 15e-9;

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// 0.4 x 0.2 mm unless said otherwise, centred between its ends.
Bead bead(const Vec3& from, const Vec3& to, const Vec3& up = Vec3::UnitZ(), double width = 0.4e-3,
          double height = 0.2e-3) {
  Bead b;
  b.from_W = narrow(from);
  b.to_W = narrow(to);
  b.up_W = narrow(up);
  b.width = static_cast<float>(width);
  b.height = static_cast<float>(height);
  return b;
}

Bead along_x(double z, double y = 0) { return bead(Vec3(-5e-3, y, z), Vec3(5e-3, y, z)); }

Pose over(double x, double y, double height, double tilt = 0) {
  return make_pose(exp_rotation(Vec3(0, tilt, 0)), Vec3(x, y, height));
}

// A box from `lower` to `upper`; only its top when it is open.
std::shared_ptr<const geometry::Mesh> box(const Vec3& lower, const Vec3& upper, bool open = false) {
  if (!open) return geometry::box_mesh(lower, upper);
  const auto& all = geometry::box_triangles();
  return std::make_shared<geometry::Mesh>(geometry::box_corners(lower, upper),
                                          std::vector(all.begin() + 2, all.begin() + 4));
}

double gap(const Workpiece& work, const Pose& X, std::size_t before = BeadIndex::kAll) {
  return work.below(X, before).value().distance;
}

TEST(Workpiece, GapOverAPrintedLayerIsToItsTop) {
  Workpiece work(nullptr);
  work.add(along_x(0.1e-3));
  for (const double tilt_deg : {0.0, 20.0, -35.0}) {
    const double tilt = from_deg(tilt_deg);
    for (const double height : {0.15e-3, 2e-3, -0.05e-3, -0.15e-3}) {
      const auto below = work.below(over(1e-3, 0.05e-3, 0.2e-3 + height, tilt));
      ASSERT_TRUE(below);
      EXPECT_NEAR(below->distance, height / std::cos(tilt), kFloat);
      EXPECT_NEAR(below->place_W.z(), 0.2e-3, kFloat);
      EXPECT_NEAR((below->normal_W - Vec3::UnitZ()).norm(), 0, 1e-6);
      EXPECT_EQ(below->body, Workpiece::Body::bead);
    }
    // Beside it, the table; without it, too.
    EXPECT_NEAR(gap(work, over(1e-3, 0.25e-3, 0.5e-3, tilt)), 0.5e-3 / std::cos(tilt), kFloat);
    EXPECT_NEAR(gap(work, over(1e-3, 0, 0.5e-3, tilt), 0), 0.5e-3 / std::cos(tilt), kFloat);
  }
  // On the half-round side: y = 0.15 mm is half a radius out of the flat.
  EXPECT_NEAR(gap(work, over(0, 0.15e-3, 1e-3)), 0.9e-3 - 0.1e-3 * std::sqrt(0.75), kFloat);
}

TEST(Workpiece, BeadsDeeperThanTheReachAreNotLookedFor) {
  Workpiece work(nullptr);
  work.add(along_x(0.1e-3));  // top at 0.2 mm, on the table
  const auto gap_within = [&](double reach, std::size_t likely) {
    return work.below(over(0, 0, 0.5e-3), BeadIndex::kAll, likely, reach).value().distance;
  };
  for (const std::size_t likely : {BeadIndex::kAll, std::size_t{0}}) {
    EXPECT_NEAR(gap_within(0.31e-3, likely), 0.3e-3, kFloat);
    EXPECT_NEAR(gap_within(0.29e-3, likely), 0.5e-3, kFloat);
  }
}

TEST(Workpiece, GapOverATiltedLayerIsAlongTheToolAxis) {
  // Layers on a slope of 40 degrees about y, as a tilting table prints them.
  const double slope = from_deg(40);
  const Mat3 R = exp_rotation(Vec3(0, slope, 0));
  const Vec3 origin(0, 0, 30e-3), up = R.col(2);
  Workpiece work(nullptr);
  for (int layer = 0; layer < 3; ++layer) {
    for (int line = -10; line <= 10; ++line) {
      const auto at = [&](double x) -> Vec3 {
        return origin + R * Vec3(x, 0.35e-3 * line, (layer + 0.5) * 0.2e-3);
      };
      work.add(bead(at(-4e-3), at(4e-3), up));
    }
  }
  const Vec3 top = origin + R * Vec3(1e-3, 0, 0.6e-3);
  for (const double g : {0.13e-3, 1e-3, -0.1e-3, -0.5e-3}) {
    EXPECT_NEAR(gap(work, make_pose(R, top + g * up)), g, kFloat) << "tool along the normal";
    EXPECT_NEAR(gap(work, make_pose(Quat::Identity(), top + g * Vec3::UnitZ())), g, kFloat)
        << "tool upright: the same foot, along its own axis";
  }
}

TEST(Workpiece, TheWayUpGoesThroughTheWholeHeap) {
  Workpiece work(nullptr);
  for (int i = 0; i < 6; ++i) work.add(along_x(0.1e-3 + 0.2e-3 * i));
  work.add(bead(Vec3(0, -1e-3, 1.25e-3), Vec3(0, 1e-3, 1.25e-3)));  // crosses, 0.05 mm into the last
  work.add(along_x(1.8e-3));                                        // 0.35 mm of air above
  const double top = 1.35e-3, tip = 0.33e-3;
  EXPECT_NEAR(gap(work, over(0, 0, tip)), tip - top, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, -1e-3)), -1e-3 - top, kFloat) << "in the table";
  EXPECT_NEAR(gap(work, over(2e-3, 0, tip)), tip - 1.2e-3, kFloat) << "where nothing crosses";
  EXPECT_NEAR(gap(work, over(2e-3, 0, tip), 3), tip - 0.6e-3, kFloat) << "before the rest was laid";
  EXPECT_NEAR(gap(work, over(0, 0, 1.5e-3)), 0.15e-3, kFloat) << "under the roof";
}

TEST(Workpiece, ARoofAboveTheTipDoesNotCount) {
  Workpiece work(box(Vec3(-0.02, -0.02, 4e-3), Vec3(0.02, 0.02, 8e-3)));
  work.add(along_x(0.1e-3));
  work.add(along_x(1.1e-3));
  EXPECT_NEAR(gap(work, over(0, 0, 0.33e-3)), 0.13e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, 1.5e-3)), 0.3e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 1e-3, 1.5e-3)), 1.5e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, 5e-3)), -3e-3, kFloat) << "inside the roof";
}

TEST(Workpiece, TheInsertUnderABeadAndTheBeadAreOneHeap) {
  Workpiece work(box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 10e-3)));
  work.add(along_x(10.1e-3));
  EXPECT_NEAR(gap(work, over(0, 0, 9.5e-3)), -0.7e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, 1e-3)), -9.2e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 1e-3, 9.5e-3)), -0.5e-3, kFloat);
  EXPECT_EQ(work.below(over(0, 1e-3, 9.5e-3))->body, Workpiece::Body::insert);
}

TEST(Workpiece, BeadOnTheBottleTakesItsHeightOffTheGap) {
  const auto bottle = geometry::read_stl(std::string(UNDERSTUDY_SOURCE_DIR) + "/models/parts/bottle.stl");
  const Vec3 middle = 0.5 * (bottle->lower() + bottle->upper());
  for (const double aside : {0.0, 4e-3, -7e-3}) {
    // A tool along the surface's normal, 0.33 mm above it, the bead between them.
    const Vec3 above(middle.x() + aside, middle.y(), bottle->upper().z() + 5e-3);
    const auto foot = bottle->ray_hit(above, -Vec3::UnitZ(), 0.05);
    ASSERT_TRUE(foot);
    const Vec3 n = foot->normal, along = n.unitOrthogonal();
    Workpiece work(bottle);
    const Vec3 centre = foot->position + 0.1e-3 * n;
    work.add(bead(centre - 0.5e-3 * along, centre + 0.5e-3 * along, n));
    const auto tool = [&](double height) {
      return make_pose(shortest_arc_from_z(n), foot->position + height * n);
    };
    EXPECT_NEAR(gap(work, tool(0.33e-3), 0), 0.33e-3, kFloat);
    EXPECT_NEAR(gap(work, tool(0.33e-3)), 0.13e-3, kFloat);
    EXPECT_NEAR(gap(work, tool(0.05e-3)), -0.15e-3, kFloat);
    EXPECT_NEAR(gap(work, tool(-0.3e-3)), -0.5e-3, kFloat) << "through bottle and bead";
    EXPECT_EQ(work.below(tool(0.33e-3))->body, Workpiece::Body::bead);
  }
}

TEST(Workpiece, WithoutBeadsTheGapIsThatToPartOrTable) {
  const auto plate = box(Vec3(-0.02, -0.02, 1e-3), Vec3(0.02, 0.02, 10e-3));
  const Workpiece work(plate);
  for (const double x : {0.0, 0.03}) {
    for (const double z : {-2e-3, 0.5e-3, 9e-3, 11e-3, 45e-3}) {
      // In the table as well as under the part, the way up goes on through the part only where it lies on it.
      const Pose X_WT = over(x, 0, z, 0.2);
      const Vec3 tip = X_WT.translation(), axis = tool_axis(X_WT);
      const double nearer = std::min(table_gap({}, tip, axis).gap, part_gap(*plate, tip, axis).gap);
      EXPECT_NEAR(gap(work, X_WT), nearer, 1e-15) << x << ' ' << z;
    }
  }
  EXPECT_FALSE(work.below(over(0.03, 0, 0.0501)));
  EXPECT_FALSE(work.below(over(0.03, 0, 0.01, std::numbers::pi)));
}

TEST(Workpiece, AnOpenInsertIsMetFromOutside) {
  const Workpiece work(box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 20e-3), true));  // its lid alone
  EXPECT_NEAR(gap(work, over(0, 0, 21e-3)), 1e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, 19.9e-3)), -0.1e-3, kFloat);
  EXPECT_NEAR(gap(work, over(0, 0, 10e-3)), 10e-3, kFloat) << "far below it, the table";
  EXPECT_NEAR(work.nearest(Vec3(0, 0, 19e-3), 5e-3)->distance, 1e-3, kFloat);
}

TEST(Workpiece, RaysMeetBeadsBeforeWhatTheyLieOn) {
  Workpiece work(box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 10e-3)));
  work.add(along_x(10.1e-3));
  const Vec3 down = Vec3(0, 1, -1).normalized();
  const auto hit = [&](double y, std::size_t before) {
    return work.ray_hit(Vec3(0, y - 5e-3, 15e-3), down, 0.1, before).value();
  };
  // The ray meets z = 10.2 mm where y is 0.2 mm short of where it meets the insert.
  EXPECT_EQ(hit(0.25e-3, BeadIndex::kAll).body, Workpiece::Body::bead);
  EXPECT_NEAR(hit(0.25e-3, BeadIndex::kAll).distance, 4.8e-3 * std::numbers::sqrt2, kFloat);
  EXPECT_EQ(hit(0.25e-3, 0).body, Workpiece::Body::insert);
  EXPECT_NEAR(hit(0.25e-3, 0).distance, 5e-3 * std::numbers::sqrt2, kFloat);
  EXPECT_EQ(hit(0.6e-3, BeadIndex::kAll).body, Workpiece::Body::insert) << "past the bead";
  EXPECT_EQ(work.ray_hit(Vec3(0.03, 0, 5e-3), -Vec3::UnitZ(), 0.1)->body, Workpiece::Body::table);
  EXPECT_FALSE(work.ray_hit(Vec3(0.03, 0, -5e-3), Vec3::UnitZ(), 0.1)) << "the table from below";
  EXPECT_EQ(work.ray_hit(Vec3(0, 0, 10.1e-3), -Vec3::UnitZ(), 0.1)->distance, 0) << "from inside a bead";
}

TEST(Workpiece, NearestIsTheNearestOfAll) {
  Workpiece work(box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 10e-3)));
  work.add(along_x(10.1e-3));
  EXPECT_NEAR(work.nearest(Vec3(0, 0, 10.5e-3), 1e-3)->distance, 0.3e-3, kFloat);
  EXPECT_EQ(work.nearest(Vec3(0, 2e-3, 10.5e-3), 1e-3)->body, Workpiece::Body::insert);
  EXPECT_NEAR(work.nearest(Vec3(0, 2e-3, 9e-3), 2e-3)->distance, -1e-3, kFloat);
  EXPECT_EQ(work.nearest(Vec3(0.05, 0, 1e-3), 2e-3)->body, Workpiece::Body::table);
  EXPECT_FALSE(work.nearest(Vec3(0.05, 0, 3e-3), 2e-3));
}

TEST(Workpiece, RefusesToAnswerForNowhere) {
  const Workpiece work(nullptr);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(work.below(over(nan, 0, 0)), MachineError);
  EXPECT_THROW(work.nearest(Vec3(0, nan, 0), 1), MachineError);
  EXPECT_THROW(work.ray_hit(Vec3(0, nan, 0), Vec3::UnitZ(), 1), MachineError);
}

}  // namespace
}  // namespace understudy::sim
