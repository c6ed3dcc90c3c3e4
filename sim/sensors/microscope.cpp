#include "sim/sensors/microscope.h"

#include "renderer/laser_view.h"

namespace understudy::sim {
namespace {

renderer::LaserScene scene_of(const machine::MachineDescription& machine,
                              std::shared_ptr<const geometry::Mesh> part, std::uint64_t seed,
                              const MicroscopeOptions& options) {
  renderer::LaserScene scene;
  scene.part = std::move(part);
  scene.tool_bodies = machine.tool.bodies;
  scene.X_TC = machine.microscope.X_TC;
  scene.X_TL = machine.laser.X_TL;
  scene.camera = machine.microscope.camera;
  scene.waist_diameter = machine.laser.waist_diameter;
  scene.wavelength = machine.laser.wavelength;
  scene.peak_level = machine.laser.peak_level;
  scene.ambient_level = machine.microscope.ambient_level;
  scene.aperture_sine = machine.microscope.aperture_sine;
  scene.blur_px = machine.microscope.blur_px;
  scene.full_well = machine.microscope.full_well;
  scene.read_noise = machine.microscope.read_noise;
  scene.speckle = options.speckle;
  scene.noise = options.noise;
  scene.table_top = options.table;
  scene.seed = seed;
  return scene;
}

}  // namespace

struct Microscope::State {
  renderer::LaserScene scene;
  renderer::LaserView view;
};

Microscope::Microscope(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> part,
                       std::uint64_t seed, const MicroscopeOptions& options)
    : state_(std::make_unique<State>()) {
  state_->scene = scene_of(machine, std::move(part), seed, options);
}

Microscope::~Microscope() = default;

void Microscope::set_printed(std::shared_ptr<const geometry::Mesh> beads) {
  state_->scene.printed = std::move(beads);
}

Image Microscope::expose(const Pose& X_WT_true, const Region& region, std::uint64_t frame_number) {
  state_->scene.X_WT = X_WT_true;
  state_->scene.frame = frame_number;
  return state_->view.render(state_->scene, region);
}

std::optional<Vec2> Microscope::true_dot(const Pose& X_WT_true) const {
  renderer::LaserScene scene = state_->scene;
  scene.X_WT = X_WT_true;
  Vec2 pixel;
  if (!renderer::true_dot(scene, pixel)) return std::nullopt;
  return pixel;
}

}  // namespace understudy::sim
