#include "sim/as_built/as_built.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/random_vector.h"
#include "machine/fixture_file.h"
#include "machine/optics_mounting.h"
#include "sim/as_built/as_built_file.h"
#include "sim/as_built/calibrated_draw.h"
#include "sim/as_built/world_draw.h"

namespace understudy::sim {
namespace {

void add_strut_errors(const machine::ToleranceSet& tolerance, AsBuilt& built) {
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    Random random(built.seed, fmt::format("as-built/{}/strut {}", built.source, i + 1));
    built.hexapod.base_joint[s] += tolerance.joint_position * normal_vec3(random);
    built.hexapod.platform_joint[s] += tolerance.joint_position * normal_vec3(random);
    built.hexapod.length_offset[s] += tolerance.length_offset * random.normal();
  }
}

void add_axis_errors(const machine::ToleranceSet& tolerance, AsBuilt& built) {
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
    kinematics::ChainAxis& axis = built.chain.axes[i];
    Random random(built.seed, fmt::format("as-built/{}/axis {}", built.source, axis.name));
    // The part of a tilt along the axis itself is a turn about it: nothing.
    axis.direction =
        (exp_rotation(tolerance.axis_direction * normal_vec3(random)) * axis.direction).normalized();
    axis.point += tolerance.axis_position * normal_vec3(random);
    built.axis_zero[i] = (axis.angle ? tolerance.zero_angle : tolerance.zero_length) * random.normal();
    if (!built.chain.rods.empty()) built.chain.rods[i] += tolerance.rod_length * random.normal();
  }
  Random random(built.seed, fmt::format("as-built/{}/tool", built.source));
  built.chain.X_OT_zero.translation() += tolerance.axis_position * normal_vec3(random);
}

void add_errors(const machine::ToleranceSet& tolerance, AsBuilt& built) {
  if (built.chain.axes.empty())
    add_strut_errors(tolerance, built);
  else
    add_axis_errors(tolerance, built);
}

enum class Geometry { drawn, described };

AsBuilt without_errors(const machine::MachineDescription& machine, Geometry geometry) {
  const bool before_calibration = geometry == Geometry::drawn && machine.calibration;
  AsBuilt built;
  built.machine = machine.name;
  machine.visit(
      [&](const machine::HexapodModel& hexapod) {
        built.hexapod = before_calibration ? hexapod.design : hexapod.geometry;
        built.nut_play.fill(hexapod.play.screw_nut);
        built.ball_play.fill(hexapod.play.ball_joint);
      },
      [&](const machine::ChainModel& chain) {
        built.chain = before_calibration ? chain.kinematics.design : chain.kinematics.chain;
        for (std::size_t i = 0; i < built.chain.axes.size(); ++i) built.axis_play[i] = chain.play[i];
      });
  built.laser = machine.laser;
  built.microscope = machine.microscope;
  if (geometry == Geometry::drawn) {
    machine::set_mounting(machine::drawn_mounting(machine), built.laser, built.microscope);
    built.laser.waist_diameter = machine::drawn_waist(machine);
  }
  built.filament_diameter = machine.tool.filament_diameter;
  built.extruder_lag = machine.process.extruder_lag;
  if (const auto* table = std::get_if<geometry::Box>(&machine.table.form)) {
    built.table.radius = 0.5 * table->size.head<2>().minCoeff();
    built.table.half_sides = 0.5 * table->size.head<2>();
  }
  return built;
}

}  // namespace

AsBuilt as_described(const machine::MachineDescription& machine) {
  return without_errors(machine, Geometry::described);
}

AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set,
                      const TruthSeeds& seeds, const std::string& fixture) {
  if (set == "calibrated") return draw_calibrated(machine, seeds, fixture);
  AsBuilt built = without_errors(machine, Geometry::drawn);
  built.source = set;
  built.seed = seeds[TruthGroup::geometry];
  if (set == "sampled") {
    add_errors(machine.tolerances.after_calibration, built);
  } else if (set == "manufactured") {
    add_errors(machine.tolerances.manufactured, built);
    if (machine.tolerances.mounting) draw_mounting(*machine.tolerances.mounting, seeds, built);
    // A description that was made in memory has no file, and no tolerances but its own.
    if (!machine.file.empty())
      draw_world(machine::load_built_tolerances(machine.file.string(), fixture), seeds, built);
  } else if (set != "nominal") {
    read_as_built(set, built);
  }
  return built;
}

std::string default_as_built(const machine::MachineDescription& machine) {
  return machine.calibration ? "calibrated" : "sampled";
}

}  // namespace understudy::sim
