// What the build with the twin adds.
#include <stdexcept>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/doctor.h"
#include "cli/twin/campaign/campaign_command.h"
#include "cli/twin/compensation_commands.h"
#include "cli/watch/live_server.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "rehearsal/library_versions.h"
#include "renderer/scene_view.h"
#include "report/gltf/replay_glb.h"
#include "report/page/pack.h"
#include "report/page/page_parts.h"
#include "report/trace/trace_hdf5.h"
#include "sim/as_built/as_built.h"
#include "sim/plant/plant.h"

namespace understudy::cli {
namespace {

std::string try_plant() {
  const auto machine = machine::load_machine(machine::kDefaultMachine);
  const auto plant = sim::make_mujoco_plant(machine, sim::make_as_built(machine, "nominal", 1));
  kinematics::AxisVector home{};
  if (machine.make_mechanism()->inverse(machine.X_BT_home, {}, home) != kinematics::SolveStatus::ok)
    throw std::runtime_error("home cannot be reached");
  const kinematics::AxisVector zero = machine.drive_zero();
  for (std::size_t i = 0; i < home.size(); ++i) home[i] -= zero[i];
  plant->reset(home);
  for (int i = 0; i < 100; ++i) plant->step({home, {}});
  return fmt::format("{}, closure {:.3f} um at rest", plant->engine(), to_um(plant->closure_error()));
}

std::string try_renderer() {
  renderer::PictureScene scene;
  scene.shapes.push_back({{"ball", geometry::Sphere{0.01}}, {1, 0, 0}});
  scene.eye_W = Vec3(0.1, 0, 0);
  scene.width = scene.height = 64;
  const auto picture = renderer::render_picture(scene);
  const auto* middle = &picture.rgb[static_cast<std::size_t>(3 * (32 * 64 + 32))];
  if (!(middle[0] > middle[1] + 20)) throw std::runtime_error("a red ball does not look red");
  return "OSMesa renders off screen";
}

}  // namespace

void add_twin_commands(CLI::App& app, Action& action) {
  add_rehearse(app, action);
  add_inspect(app, action);
  add_compensate(app, action);
  add_serve(app, action);
  add_pose(app, action);
  add_place(app, action);
  add_verify(app, action);
  add_compare(app, action);
  add_register(app, action);
  add_scenario(app, action);
  add_sweep(app, action);
  add_campaign(app, action);
  add_sample_poses(app, action);
  add_sample_gaps(app, action);
  add_render(app, action);
  add_workspace(app, action);
  add_repeatability(app, action);
  add_benchmark(app, action);
  add_schema(app, action);
}

std::vector<std::string> left_out_commands() { return {}; }

LibraryVersions library_versions_of_rooms() {
  LibraryVersions all = rehearsal::library_versions();
  all["HDF5"] = report::loaded_hdf5();
  all["cpp-httplib"] = loaded_httplib();
  all["tinygltf"] = report::loaded_tinygltf();
  all["zlib"] = report::loaded_zlib();
  all.merge(report::page_packages());
  return all;
}

std::vector<HealthCheck> twin_self_test() {
  return {attempt("mujoco", try_plant), attempt("renderer", try_renderer)};
}

}  // namespace understudy::cli
