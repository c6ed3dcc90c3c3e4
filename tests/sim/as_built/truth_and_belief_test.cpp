// The built machine and its controller's description share no number of the geometry: either moves alone.
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "sim/as_built/as_built.h"
#include "sim/as_built/as_built_file.h"
#include "sim/plant/plant.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using machine::MachineDescription;

// 1 sigma of manufacture of the shipped machines, and more of dev than calibrations find.
constexpr double kLength = 0.3e-3;  // [m]
constexpr double kAngle = 1e-3;     // [rad]

/// One number of a geometry, moved.
template <typename Geometry>
struct Move {
  std::string name;
  std::function<void(Geometry&)> apply;
};

std::vector<Move<kinematics::HexapodGeometry>> hexapod_moves() {
  using G = kinematics::HexapodGeometry;
  std::vector<Move<G>> moves{{"dev", [](G& g) { g.deviation += kLength; }}};
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    for (int k = 0; k < 3; ++k) {
      moves.push_back(
          {fmt::format("base joint {} {}", i + 1, "xyz"[k]), [=](G& g) { g.base_joint[i][k] += kLength; }});
      moves.push_back({fmt::format("platform joint {} {}", i + 1, "xyz"[k]),
                       [=](G& g) { g.platform_joint[i][k] += kLength; }});
    }
    moves.push_back({fmt::format("length offset {}", i + 1), [=](G& g) { g.length_offset[i] += kLength; }});
  }
  return moves;
}

std::vector<Move<kinematics::Chain>> arm_moves() {
  using C = kinematics::Chain;
  std::vector<Move<C>> moves;
  for (int k = 0; k < 3; ++k) {
    const Vec3 unit = Vec3::Unit(k);
    moves.push_back(
        {fmt::format("tool {}", "xyz"[k]), [=](C& c) { c.X_OT_zero.translation() += kLength * unit; }});
    moves.push_back(
        {fmt::format("work {}", "xyz"[k]), [=](C& c) { c.X_OS_zero.translation() += kLength * unit; }});
  }
  for (std::size_t i = 0; i < 6; ++i) {
    moves.push_back({fmt::format("direction of axis {}", i + 1), [=](C& c) {
                       Vec3& d = c.axes[i].direction;
                       d = (exp_rotation(kAngle * d.unitOrthogonal()) * d).normalized();
                     }});
    moves.push_back({fmt::format("point of axis {}", i + 1),
                     [=](C& c) { c.axes[i].point += kLength * c.axes[i].direction.unitOrthogonal(); }});
  }
  return moves;
}

kinematics::HexapodGeometry& truth_of(AsBuilt& built, const kinematics::HexapodGeometry&) {
  return built.hexapod;
}
kinematics::Chain& truth_of(AsBuilt& built, const kinematics::Chain&) { return built.chain; }
kinematics::HexapodGeometry& belief_of(MachineDescription& m, const kinematics::HexapodGeometry&) {
  return m.hexapod().geometry;
}
kinematics::Chain& belief_of(MachineDescription& m, const kinematics::Chain&) {
  return m.chain().kinematics.chain;
}

/// As load_machine() leaves a machine whose calibration found the drawing itself.
MachineDescription calibrated(const char* name) {
  MachineDescription m = machine::load_machine(name);
  if (m.is_chain()) m.chain().kinematics.design = m.chain().kinematics.chain;
  m.calibration.emplace();
  return m;
}

/// Off home, so that every number matters to the tip.
Pose asked_pose(const MachineDescription& m) {
  return make_pose(Mat3(exp_rotation(Vec3(0.1, -0.07, 0.05)) * m.X_BT_home.linear()),
                   m.X_BT_home.translation() + Vec3(10e-3, -15e-3, 12e-3));
}

/// What the drives are sent to for that pose.
kinematics::AxisVector commanded(const MachineDescription& m) {
  kinematics::AxisVector axes{};
  const auto mechanism = m.make_mechanism();
  const auto used = std::span(axes).first(static_cast<std::size_t>(mechanism->axis_count()));
  EXPECT_EQ(mechanism->inverse(asked_pose(m), {}, used), kinematics::SolveStatus::ok);
  const auto zero = m.drive_zero();
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] -= zero[i];
  return axes;
}

/// Where the tip then is.
Vec3 reached(const MachineDescription& m, const AsBuilt& built, const kinematics::AxisVector& displacement) {
  const auto plant = make_quasistatic_plant(m, built);
  plant->reset(displacement);
  return plant->tool_pose().translation();
}

/// All true numbers, without the name of the set.
std::string numbers(AsBuilt built) {
  built.source.clear();
  return write_as_built(built);
}

template <typename Geometry>
void expect_apart(const MachineDescription& machine, const std::vector<Move<Geometry>>& moves) {
  const TemporaryFolder folder;
  const std::string file = (folder / "built.yaml").string();
  write_file(file, write_as_built(make_as_built(machine, "manufactured", 3)));
  const std::array<std::string, 4> sets{"nominal", "sampled", "manufactured", file};
  const AsBuilt truth = make_as_built(machine, "manufactured", 3);
  const kinematics::AxisVector drives = commanded(machine);
  const Vec3 tip = reached(machine, truth, drives);
  for (const Move<Geometry>& move : moves) {
    SCOPED_TRACE(move.name);
    MachineDescription known = machine;
    AsBuilt moved = truth;
    move.apply(truth_of(moved, Geometry{}));
    EXPECT_GT((reached(known, moved, drives) - tip).norm(), 1e-6) << "the truth did not move";
    EXPECT_EQ(commanded(known), drives) << "the belief moved with the truth";

    move.apply(belief_of(known, Geometry{}));
    EXPECT_NE(commanded(known), drives) << "the belief did not move";
    for (const std::string& set : sets)
      EXPECT_EQ(numbers(make_as_built(known, set, 3)), numbers(make_as_built(machine, set, 3)))
          << set << " moved with the belief";
    EXPECT_EQ(reached(known, truth, drives), tip) << "the plant looked at the belief";
  }
}

TEST(TruthAndBelief, AHexapodsNumbersMoveAlone) { expect_apart(calibrated("hexapod"), hexapod_moves()); }

TEST(TruthAndBelief, AHexapodsScrewsTurnAsItsJointsDoAndNotAsTheControllerBelieves) {
  MachineDescription machine = calibrated("hexapod");
  machine.hexapod().screw_rotation = machine::ScrewRotation::free;
  expect_apart(machine, hexapod_moves());
}

TEST(TruthAndBelief, AnArmsNumbersMoveAlone) { expect_apart(calibrated("arm"), arm_moves()); }

}  // namespace
}  // namespace understudy::sim
