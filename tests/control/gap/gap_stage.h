// A start on a part and a rig that stands at its S', for tests of the approach.
#pragma once

#include <gtest/gtest.h>

#include "tests/control/gap/gap_rig.h"
#include "tests/shipped_hexapod.h"

namespace understudy::control {

constexpr double kBottleRadius = 15.5e-3;   // [m]
constexpr double kProgrammedGap = 0.13e-3;  // [m], of S over the nominal part
constexpr double kStandoff = 2e-3;          // [m]

/// A start on a part: S and the part's surface below it as the controller believes them.
struct Start {
  Pose X_WT_S;
  LocalSurface surface;
  DotWorld world;
};

/// On a bottle along y whose crown is at the home tip, `degrees` around it, the tool on the normal.
inline Start on_bottle(double degrees) {
  const double a = from_deg(degrees);
  const Vec3 normal(std::sin(a), 0, std::cos(a)), axis_point(0, 0, 0.05 - kBottleRadius);
  Start start;
  start.world = cylinder_around(axis_point, Vec3::UnitY(), kBottleRadius);
  start.X_WT_S =
      make_pose(shortest_arc_from_z(normal), Vec3(axis_point + (kBottleRadius + kProgrammedGap) * normal));
  start.surface.curvature(0, 0) = -1 / kBottleRadius;
  return start;
}

/// On a plane through the home tip that leans away from the upright tool, towards the laser.
inline Start on_slope(double degrees) {
  Start start;
  const double a = from_deg(degrees);
  start.world = plane_through(Vec3(0, 0, 0.05), Vec3(0, -std::sin(a), std::cos(a)));
  start.X_WT_S = make_pose(Quat::Identity(), Vec3(0, 0, 0.05 + kProgrammedGap));
  start.surface.slope.y() = std::tan(a);
  return start;
}

/// A rig that stands at S' of a start, with a tip error of `gap_error` along the axis and `sideways` beside
/// it.
class Stage {
 public:
  explicit Stage(const Start& start, double gap_error = 0, const Vec3& sideways = Vec3::Zero(),
                 const Vec3& tool_error = Vec3::Zero(), std::uint64_t seed = 1)
      : start_(start),
        rig_(hexapod(),
             {start.world, gap_error * tool_axis(start.X_WT_S) + sideways, tool_error, 0.35, seed}),
        motion_(hexapod(), rig_) {
    Pose X = start.X_WT_S;
    X.translation() += kStandoff * tool_axis(X);
    EXPECT_EQ(motion_.move_to(X), machine::Status::ok);
    motion_.targets.clear();
    history_begin_ = rig_.port().history().size();
  }

  GapOutcome run(const GapControllerOptions& options = {}) {
    return close_gap(hexapod(), start_.surface, start_.X_WT_S, kStandoff, motion_, options);
  }
  GapRig& rig() { return rig_; }
  RigMotion& motion() { return motion_; }
  double height(const Pose& X) const {
    return (X.translation() - start_.X_WT_S.translation()).dot(tool_axis(start_.X_WT_S));
  }
  double height_now() const { return height(rig_.commanded_now()); }

  /// What the drives executed since the approach began: smallest true gap, largest step upwards.
  struct Way {
    double gap_min = 1, climb_max = 0;
  };
  Way way() const {
    Way way;
    double last = kStandoff;
    const auto& history = rig_.port().history();
    for (std::size_t i = history_begin_; i < history.size(); i += 10) {
      const Pose X = rig_.commanded(history[i].position);
      way.gap_min = std::min(way.gap_min, rig_.gap_at(X));
      way.climb_max = std::max(way.climb_max, height(X) - last);
      last = height(X);
    }
    way.gap_min = std::min(way.gap_min, rig_.gap_now());
    return way;
  }

 private:
  Start start_;
  mutable GapRig rig_;
  RigMotion motion_;
  std::size_t history_begin_ = 0;
};

}  // namespace understudy::control
