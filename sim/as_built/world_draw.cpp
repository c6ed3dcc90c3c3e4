#include "sim/as_built/world_draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "core/random_vector.h"
#include "machine/optics_mounting.h"

namespace understudy::sim {
namespace {

using machine::BuiltTolerances;

class Draws {
 public:
  Draws(const TruthSeeds& seeds, TruthGroup group, const AsBuilt& built)
      : seed_(seeds[group]), set_(built.source) {}
  Random stream(const std::string& truth) const {
    return Random(seed_, fmt::format("as-built/{}/{}", set_, truth));
  }
  double normal(const std::string& truth, double sigma) const { return sigma * stream(truth).normal(); }
  double phase(const std::string& truth) const { return stream(truth).uniform(0, 2 * std::numbers::pi); }
  Vec3 vector(const std::string& truth, double sigma) const {
    Random random = stream(truth);
    return sigma * normal_vec3(random);
  }
  /// `value` times what may not turn it round.
  void scale(const std::string& truth, double share, double& value) const {
    value *= std::max(0.0, 1 + normal(truth, share));
  }

 private:
  std::uint64_t seed_;
  std::string set_;
};

void draw_drives(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws lead(seeds, TruthGroup::lead, built), periodic(seeds, TruthGroup::periodic, built);
  const auto& axes = built.chain.axes;
  const std::size_t count = axes.empty() ? kinematics::kStruts : axes.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!axes.empty() && axes[i].angle) continue;  // a gear has no lead
    DriveError& drive = built.drives[i];
    const std::string of = fmt::format("drive {}", i + 1);
    drive.scale += lead.normal(of + " lead", t.lead);
    drive.periodic += std::abs(periodic.normal(of + " periodic", t.periodic));
    drive.phase = periodic.phase(of + " phase");
  }
}

void draw_play(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws draws(seeds, TruthGroup::play, built);
  for (std::size_t i = 0; i < built.nut_play.size(); ++i) {
    draws.scale(fmt::format("nut play {}", i + 1), t.play, built.nut_play[i]);
    draws.scale(fmt::format("ball play {}", i + 1), t.play, built.ball_play[i]);
  }
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i)
    draws.scale(fmt::format("axis play {}", i + 1), t.play, built.axis_play[i]);
}

void draw_optics(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws light(seeds, TruthGroup::light, built), camera(seeds, TruthGroup::camera, built);
  machine::Microscope& microscope = built.microscope;
  light.scale("laser power", t.laser_power, built.laser.peak_level);
  light.scale("laser waist", t.waist, built.laser.waist_diameter);
  light.scale("ambient light", t.ambient_light, microscope.ambient_level);
  microscope.camera.centre_px += camera.vector("camera centre", t.camera_centre).head<2>();
  microscope.camera.k1 += camera.normal("camera distortion", t.distortion);
  camera.scale("camera blur", t.blur, microscope.blur_px);
}

void draw_part(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws place(seeds, TruthGroup::part_place, built), shape(seeds, TruthGroup::part_shape, built);
  BuiltPart& part = built.part;
  part.X_WF = make_pose(exp_rotation(place.vector("part rotation", t.part_rotation)),
                        place.vector("part position", t.part_position)) *
              part.X_WF;
  shape.scale("part size", t.part_size, part.size);
  part.ripple += std::abs(shape.normal("part ripple", t.part_ripple));
  part.phase = shape.phase("part phase");
}

void draw_table(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws draws(seeds, TruthGroup::table, built);
  built.table.height += draws.normal("table height", t.table_height);
  built.table.slope += draws.vector("table tilt", t.table_tilt).head<2>();
  built.table.bow += draws.normal("table bow", t.table_flatness);
}

void draw_process(const TruthSeeds& seeds, const BuiltTolerances& t, AsBuilt& built) {
  const Draws draws(seeds, TruthGroup::process, built);
  built.filament_diameter += draws.normal("filament diameter", t.filament_diameter);
  draws.scale("extruder lag", t.extruder_lag, built.extruder_lag);
  built.nozzle_offset += draws.normal("nozzle temperature", t.nozzle_temperature);
}

}  // namespace

void draw_mounting(const machine::MountingTolerances& tolerances, const TruthSeeds& seeds, AsBuilt& built) {
  const Draws draws(seeds, TruthGroup::mounting, built);
  machine::MountingVector error = machine::mounting_sigmas(tolerances);
  for (int i = 0; i < machine::kMountingFreedoms; ++i)
    error[i] = draws.normal(machine::mounting_freedom(i), error[i]);
  move_mounting(error, built);
}

void move_mounting(const machine::MountingVector& error, AsBuilt& built) {
  const machine::OpticsMounting mounting{built.laser.X_TL, built.microscope.X_TC,
                                         built.microscope.camera.focal_px};
  machine::set_mounting(machine::moved(mounting, error), built.laser, built.microscope);
}

void draw_world(const BuiltTolerances& tolerances, const TruthSeeds& seeds, AsBuilt& built) {
  draw_drives(seeds, tolerances, built);
  draw_play(seeds, tolerances, built);
  draw_optics(seeds, tolerances, built);
  draw_part(seeds, tolerances, built);
  draw_table(seeds, tolerances, built);
  draw_process(seeds, tolerances, built);
}

}  // namespace understudy::sim
