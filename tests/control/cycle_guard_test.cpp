// What the controller does in a cycle: kinematics, the planner's next point, a port's calls, and the gap
// control along a path from the reading of a frame to the shifted setpoint.
//
// Not control-cycle code, and not guarded here: MotionPlanner::push() and finish(), which run ahead of the
// port's queue and grow the lookahead; close_gap(), which works while the axes rest; the camera's frames and
// vision::measure_dot(), which own their pixels; ContinuousGapController::record(), which keeps them for the
// report once the setpoints are queued.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "control/gap/continuous_gap_controller.h"
#include "control/gap/gap_follower.h"
#include "control/gap/gap_reading.h"
#include "control/gap/sensor_uncertainty.h"
#include "control/motion/motion_planner.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "machine/description.h"
#include "machine/loopback_port.h"
#include "machine/optics_mounting.h"
#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::control {
namespace {

using kinematics::SolveStatus;
using machine::Setpoint;
using machine::Status;

class CycleOf : public testing::TestWithParam<const char*> {
 protected:
  machine::MachineDescription machine_ = machine::load_machine(GetParam());
  std::unique_ptr<kinematics::Mechanism> mechanism_ = machine_.make_mechanism();
  std::size_t axes_ = static_cast<std::size_t>(mechanism_->axis_count());

  Pose near_home(Random& random, double shift, double turn) const {
    Pose X = mechanism_->home();
    const Vec3 a = uniform_vec3(random, turn);
    const Vec3 p = uniform_vec3(random, shift);
    X.linear() = exp_rotation(a) * X.linear();
    X.translation() += p;
    return X;
  }
};

TEST_P(CycleOf, KinematicsNeitherAllocatesNorLocksNorTouchesFiles) {
  Random random(61, "kinematics cycle");
  std::vector<Pose> poses;
  for (int i = 0; i < 200; ++i) poses.push_back(near_home(random, 0.01, 0.1));
  for (int i = 0; i < 50; ++i) poses.push_back(near_home(random, 2.0, 3.0));  // out of reach, mostly
  Pose nan = Pose::Identity();
  nan.translation().x() = std::nan("");
  poses.push_back(nan);
  kinematics::AxisVector home{}, axes{};
  ASSERT_EQ(mechanism_->inverse(mechanism_->home(), {}, std::span(home).first(axes_)), SolveStatus::ok);
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(static_cast<Eigen::Index>(axes_), 6);
  int solved = 0;
  double condition = 0;
  const Calls made = calls_of([&] {
    for (const Pose& X_BT : poses) {
      axes = home;
      const std::span<double> found(axes.data(), axes_);
      const SolveStatus status = mechanism_->inverse(X_BT, found, found);
      Pose X_back;
      static_cast<void>(mechanism_->forward(found, mechanism_->home(), X_back));
      static_cast<void>(mechanism_->axis_rates(X_BT, found, rates));
      condition += mechanism_->condition_number(X_BT, found);
      solved += status == SolveStatus::ok ? 1 : 0;
    }
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_GE(solved, 150);  // the poses near home: what was watched is what a cycle does
  EXPECT_TRUE(std::isfinite(condition));
}

TEST_P(CycleOf, TheNextPlannedPointCostsNothing) {
  const Pose X_WT_home = machine_.X_WB * mechanism_->home();
  MotionPlanner planner(*mechanism_, machine_.X_WB, motion_limits(machine_), {X_WT_home});
  Random random(62, "planned cycle");
  for (int i = 0; i < 40; ++i) {
    toolpath::Step step;
    step.kind = toolpath::StepKind::print;
    step.line = i + 1;
    step.feed = 0.02;
    step.filament = 1e-4;
    step.X_WT = machine_.X_WB * near_home(random, 2e-3, 0.02);
    planner.push(step);
  }
  planner.finish();
  PlannedPoint point;
  for (int warm = 0; warm < 10; ++warm) ASSERT_TRUE(planner.next(point));
  int points = 0;
  const Calls made = calls_of([&] {
    while (planner.next(point)) ++points;
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_GT(points, 1000);  // 40 moves of about 2 mm at 20 mm/s at most
}

INSTANTIATE_TEST_SUITE_P(Machines, CycleOf, testing::Values("hexapod", "arm", "five-axis", "finishing"),
                         [](const auto& one) {
                           std::string name = one.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(LoopbackCycle, CallsNeitherAllocateNorLockNorTouchFiles) {
  machine::LoopbackPort::Options options;
  options.history = false;  // of tests, and without end
  machine::LoopbackPort port(options);
  std::vector<Setpoint> setpoints;
  for (int i = 1; i <= 3000; ++i) {
    Setpoint s;
    s.time = 1e-3 * i;
    s.position[0] = 1e-4 * std::sin(1e-2 * i);
    s.velocity[0] = i == 3000 ? 0 : 1e-3 * std::cos(1e-2 * i);
    setpoints.push_back(s);
  }
  Status last = Status::faulted;
  const Calls made = calls_of([&] {
    static_cast<void>(port.submit(std::span<const Setpoint>(setpoints).first(100), 10));
    for (std::size_t k = 0; k < 30; ++k) {
      if (k < 29) last = port.submit(std::span<const Setpoint>(setpoints).subspan(100 * (k + 1), 100), 10);
      for (int cycle = 1; cycle <= 100; ++cycle) {
        static_cast<void>(port.wait_until(1e-3 * (100 * static_cast<double>(k) + cycle)));
        static_cast<void>(port.state());
      }
    }
    static_cast<void>(port.set_outputs({500, 1}, 10));
    static_cast<void>(port.urgent(machine::UrgentCommand::stop));
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_EQ(last, Status::ok);
  EXPECT_EQ(port.state().executed, 3000U);
}

TEST(GapCycle, FollowingAGapNeitherAllocatesNorLocks) {
  const GapFollowerOptions options = gap_follower_options(machine::load_machine("hexapod"));
  Random random(63, "followed cycle");
  GapFollower follower(options);
  double most = 0;
  int used = 0;
  const Calls made = calls_of([&] {
    follower.start_unknown(0, 0);
    GapFollower::Correction c;
    for (int cycle = 0; cycle < 4000; ++cycle) {
      const double time = 1e-3 * cycle, path = 5e-3 * time;
      c = follower.advance(1e-3, path, true);
      most = std::max(most, std::abs(c.value));
      if (cycle % 25 != 0) continue;
      const double gap = options.aim + 50e-6 * time + c.value + 5e-6 * random.normal();
      if (cycle % 200 == 0) follower.miss(time, path, GapStop::no_dot);
      used += follower.observe({time, path, c.value, gap, 5e-6}) == GapVerdict::used ? 1 : 0;
    }
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_GT(used, 140);
  EXPECT_GT(most, 100e-6);  // 50 um/s over 4 s: it did follow
}

TEST(GapCycle, ReadingAGapFromAMeasuredDotNeitherAllocatesNorLocks) {
  const auto machine = machine::load_machine("hexapod");
  const LocalSurface flat;
  int read = 0, width = 0;
  const Calls made = calls_of([&] {
    for (int k = 0; k < 100; ++k) {
      const double gap = 0.1e-3 + 2e-5 * k;
      Vec2 dot_px;
      if (!predict_dot(machine, flat, gap, dot_px)) continue;
      vision::DotMeasurement dot;
      dot.status = vision::DotStatus::ok;
      dot.position_px = dot_px;
      dot.covariance_px2 = 0.01 * Eigen::Matrix2d::Identity();
      GapReading reading;
      if (read_gap(machine, flat, dot, reading)) ++read;
      width += region_for_gap(machine, flat, gap, 1e-4, 1e-4, 40).width;
    }
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_EQ(read, 100);
  EXPECT_GT(width, 0);
}

/// A slab under the home tip whose top is at the table's height of bead_program.h.
std::unique_ptr<geometry::Mesh> slab() {
  auto box = geometry::box(Vec3(-30e-3, -30e-3, kTable - 5e-3), Vec3(30e-3, 30e-3, kTable));
  return std::make_unique<geometry::Mesh>(std::move(box.vertices), std::move(box.triangles));
}

TEST(GapCycle, TheSurfaceUnderTheToolIsFoundWithoutAllocating) {
  const auto part = slab();
  const Pose X_WT = make_pose(Quat::Identity(), Vec3(0, 0, kTable + kGap));
  const Pose beside = make_pose(Quat::Identity(), Vec3(30.5e-3, 0, kTable + kGap));
  bool on_part = false, off_part = true;
  make_ready(*part);
  const Calls made = calls_of([&] {
    on_part = find_local_surface(*part, X_WT).has_value() && height_over(*part, X_WT).has_value();
    off_part = find_local_surface(*part, beside).has_value();
  });
  EXPECT_EQ(made, Calls{});
  EXPECT_TRUE(on_part);
  EXPECT_FALSE(off_part);
}

/// 2 s of a path over a surface that rises, by a controller that believes `machine`.
void control_without_calls(const machine::MachineDescription& machine) {
  GapRig rig(machine, low_by(0));
  rig.set_play([](const Pose& X) -> Vec3 { return 0.01 * X.translation().x() * Vec3::UnitZ(); });
  const auto mesh = slab();
  make_ready(*mesh);
  const PrintedPart part{mesh.get(), {}};
  std::vector<OffsetChange> offsets;
  ContinuousGapController gap(machine, part, {{}, gap_follower_options(machine)}, rig.port(),
                              [&](const OffsetChange& change) { offsets.push_back(change); });
  const auto mechanism = machine.make_mechanism();
  const Pose X_WT_S = make_pose(Quat::Identity(), Vec3(0, 0, kTable + kGap));
  MotionPlanner planner(*mechanism, machine.X_WB, motion_limits(machine), {X_WT_S, 0.05});
  planner.push(step_to(toolpath::StepKind::print, {10e-3, 0, kTable + kGap}, 5e-3, 6, 1e-4));
  planner.finish();
  gap.start(Vec3::Zero(), kGap, 5e-6);
  Calls made;
  const auto guarded = [&](const auto& part_of_cycle) {
    const Calls here = calls_of(part_of_cycle);
    made = {made.allocations + here.allocations, made.locks + here.locks, made.io + here.io};
  };
  Status written = Status::ok;
  double farthest = 0;
  for (PlannedPoint point; planner.next(point);) {
    const double due = point.setpoint.time - gap.lead();
    while (rig.port().now() < due) {
      ASSERT_EQ(gap.read(due), Status::ok);
      guarded([&] { gap.update(); });
      gap.record();
    }
    guarded([&] {
      Setpoint ready;
      if (gap.shift(point, ready)) written = rig.port().submit(std::span(&ready, 1), 1e9);
      farthest = std::max(farthest, std::abs(ready.position[0] - point.setpoint.position[0]));
    });
    ASSERT_EQ(written, Status::ok);
    ASSERT_EQ(gap.stop(), GapStop::none) << gap.stop_cause().why;
  }
  EXPECT_EQ(made, Calls{});
  // 2 s of path, a frame in about 26 ms, and 0.1 mm of error over it.
  EXPECT_GT(gap.following().used, 60);
  EXPECT_GT(offsets.size(), 50U);
  EXPECT_GT(farthest, 1e-6);
}

TEST(GapCycle, ControllingTheGapAlongAPathNeitherAllocatesNorLocks) { control_without_calls(hexapod()); }

TEST(GapCycle, NorDoesAimingByTheUncertaintyOfACalibratedSensor) {
  machine::MachineDescription calibrated = hexapod();
  calibrated.gap_sensor = {
      machine::mounting_of(calibrated), "", "", 10, 1e-12 * machine::MountingMatrix::Identity(), {}};
  ASSERT_GT(safe_aim(calibrated, {}, kGap).sigma, 0);
  control_without_calls(calibrated);
}

}  // namespace
}  // namespace understudy::control
