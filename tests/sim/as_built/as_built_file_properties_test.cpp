// Built machines of any figures: what is written reads back.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/file/output_file.h"
#include "core/units.h"
#include "sim/as_built/as_built_file.h"
#include "tests/property.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

using property::real;
using property::whole;

const machine::MachineDescription& drawn_machine() {
  static const machine::MachineDescription machines[] = {
      machine::load_machine("hexapod"), machine::load_machine("arm"), machine::load_machine("five-axis"),
      machine::load_machine("finishing")};
  return machines[*whole(0, 3)];
}

void draw_geometry(AsBuilt& built) {
  if (built.chain.axes.empty()) {
    for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
      built.hexapod.base_joint[i] += *property::vector(0.01);
      built.hexapod.platform_joint[i] += *property::vector(0.01);
      built.hexapod.length_offset[i] += *real(-0.01, 0.01);
      built.nut_play[i] = *property::magnitude(1e-12, 1e-3);
      built.ball_play[i] = *real(0, 1e-3);
    }
    built.hexapod.deviation = *real(0, 0.02);
    return;
  }
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
    kinematics::ChainAxis& axis = built.chain.axes[i];
    axis.direction = (exp_rotation(*property::vector(0.1)) * axis.direction).normalized();
    axis.point += *property::vector(0.01);
    built.axis_zero[i] = *real(-0.05, 0.05);
    built.axis_play[i] = *real(0, 1e-3);
  }
  built.chain.X_OT_zero =
      make_pose(Mat3(built.chain.X_OT_zero.linear() * exp_rotation(*property::vector(1.5))),
                Vec3(built.chain.X_OT_zero.translation() + *property::vector(0.05)));
  built.chain.X_OS_zero.translation() += *property::vector(0.05);
}

AsBuilt drawn_built(const machine::MachineDescription& machine) {
  const std::string set = *rc::gen::element<std::string>("nominal", "sampled", "manufactured");
  AsBuilt built = make_as_built(machine, set, static_cast<std::uint64_t>(*whole(0, 1 << 20)));
  draw_geometry(built);
  return built;
}

constexpr double kTurn = 2 * std::numbers::pi;

/// The largest, in [m], [rad] and [K].
double difference(const AsBuilt& a, const AsBuilt& b) {
  double worst = 0;
  const auto differ = [&](double x) { worst = std::max(worst, std::abs(x)); };
  for (std::size_t i = 0; a.chain.axes.empty() && i < kinematics::kStruts; ++i) {
    differ((a.hexapod.base_joint[i] - b.hexapod.base_joint[i]).cwiseAbs().maxCoeff());
    differ((a.hexapod.platform_joint[i] - b.hexapod.platform_joint[i]).cwiseAbs().maxCoeff());
    differ(a.hexapod.length_offset[i] - b.hexapod.length_offset[i]);
    differ(a.nut_play[i] - b.nut_play[i]);
    differ(a.ball_play[i] - b.ball_play[i]);
  }
  if (a.chain.axes.empty()) differ(a.hexapod.deviation - b.hexapod.deviation);
  RC_ASSERT(a.chain.axes.size() == b.chain.axes.size());
  for (std::size_t i = 0; i < a.chain.axes.size(); ++i) {
    differ((a.chain.axes[i].direction - b.chain.axes[i].direction).norm());
    differ((a.chain.axes[i].point - b.chain.axes[i].point).norm());
    differ(a.axis_zero[i] - b.axis_zero[i]);
    differ(a.axis_play[i] - b.axis_play[i]);
  }
  differ((a.chain.X_OT_zero.matrix() - b.chain.X_OT_zero.matrix()).norm());
  differ((a.chain.X_OS_zero.matrix() - b.chain.X_OS_zero.matrix()).norm());
  for (std::size_t i = 0; i < a.drives.size(); ++i) {
    differ(a.drives[i].scale - b.drives[i].scale);
    differ(a.drives[i].periodic - b.drives[i].periodic);
    // A phase without an amplitude says nothing, and is not written.
    if (a.drives[i].periodic > 0) differ(std::remainder(a.drives[i].phase - b.drives[i].phase, kTurn));
  }
  differ(a.filament_diameter - b.filament_diameter);
  differ(a.extruder_lag - b.extruder_lag);
  differ(a.nozzle_offset - b.nozzle_offset);
  differ((a.part.X_WF.matrix() - b.part.X_WF.matrix()).norm());
  differ(a.part.size - b.part.size);
  differ(a.part.ripple - b.part.ripple);
  return worst;
}

// A unit is divided out and multiplied in again; quaternions and unit vectors are normalised: some roundings
// of numbers up to some metres or kelvin.
constexpr double kRounding = 1e-14;

TEST(AsBuiltFileProperties, WhatIsWrittenIsReadBackAndWritesTheSameText) {
  property::check({40}, [] {
    const machine::MachineDescription& machine = drawn_machine();
    const AsBuilt built = drawn_built(machine);
    const TemporaryFolder folder;
    const std::string path = (folder / "built.yaml").string();
    const auto through_file = [&](const AsBuilt& of) {
      write_file(path, write_as_built(of));
      return make_as_built(machine, path, 1);
    };
    const AsBuilt once = through_file(built), twice = through_file(once);
    RC_LOG() << write_as_built(built);
    RC_ASSERT(difference(once, built) < kRounding);
    RC_ASSERT(difference(twice, once) < kRounding);
  });
}

}  // namespace
}  // namespace understudy::sim
