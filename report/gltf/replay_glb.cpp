#include "report/gltf/replay_glb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/library_versions.h"
#include "core/units.h"
#include "report/gltf/gltf_scene.h"
#include "report/gltf/machine_nodes.h"
#include "sim/surface/bead_slices.h"

namespace understudy::report {
namespace {

constexpr std::size_t kSlicesMost = 10'000;

void check(const GlbSettings& settings) {
  if (settings.slices < 1 || settings.slices > kSlicesMost)
    throw InputError(
        fmt::format("{} slices of the beads: 1 to {} are possible", settings.slices, kSlicesMost));
  if (!(settings.within > 0 && std::isfinite(settings.within)))
    throw InputError(fmt::format("a bound of {} mm: one above 0 is needed", to_mm(settings.within)));
  if (!(settings.speed > 0 && std::isfinite(settings.speed)))
    throw InputError(fmt::format("a speed of {}: one above 0 is needed", settings.speed));
}

/// When the first and the last of the beads was laid [s].
std::pair<double, double> laid_between(const std::vector<sim::BeadStretch>& beads) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const auto& stretch : beads)
    for (const auto& section : stretch) {
      first = std::min(first, section.laid_at);
      last = std::max(last, section.laid_at);
    }
  return {first, last};
}

/// One node a slice, below "beads"; they are scaled from nothing to what they are when they are laid.
void add_beads(const RecordedReplay& replay, const GlbSettings& settings, int work, GltfScene& scene,
               Glb& glb) {
  const auto [first, last] = laid_between(replay.beads);
  const BeadColours colours(replay,
                            settings.colour.value_or(replay.gap_band ? BeadColour::gap : BeadColour::width));
  glb.legend = colours.legend();
  glb.slice_time = (last - first) / static_cast<double>(settings.slices);
  const int material = scene.material("filament", {1, 1, 1});  // times the vertices' colours
  const int beads = scene.node("beads", work);
  // The sides of a section are as fine as its place, as in the pictures of a report.
  for (auto& slice : sim::slice_beads(replay.beads, {settings.slices, 1.3 * replay.beads_within})) {
    const std::string name = fmt::format("beads {}", ++glb.slices);
    GltfTriangles triangles{
        std::move(slice.mesh.vertices), std::move(slice.normals), {}, std::move(slice.mesh.triangles)};
    for (const sim::BeadSection& where : slice.where) triangles.colours.push_back(colours.at(where));
    const int node = scene.node(name, beads, Pose::Identity(), scene.mesh(name, triangles, material));
    scene.show_from(node, replay.path.front().time / settings.speed, slice.by / settings.speed);
  }
}

}  // namespace

std::string loaded_tinygltf() { return loaded_version("libtinygltf", "2.7"); }

Glb replay_glb(const RecordedReplay& replay, const GlbSettings& settings) {
  check(settings);
  Glb glb;
  GltfScene scene;
  // Ours has z up, glTF's y: a quarter turn about x, of all that is below.
  const Mat3 R_YZ = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
  const int top = scene.node(replay.title, -1, make_pose(R_YZ, Vec3::Zero()));
  const MotionSettings motion{settings.within, settings.speed};
  const FrameNodes frames = add_frames(replay, motion, top, scene);
  add_machine(replay, motion, frames, scene);
  if (!replay.beads.empty()) add_beads(replay, settings, frames.work, scene, glb);
  glb.triangles = scene.triangles();
  glb.vertices = scene.vertices();
  glb.keys = scene.keys();
  glb.duration = replay.path.back().time / settings.speed;
  std::map<std::string, std::string> facts{
      {"title", replay.title},
      {"bodies", fmt::format("within {:g} mm of the record at its instants", to_mm(settings.within))},
      {"speed", fmt::format("{:g} s of the run in 1 s", settings.speed)}};
  if (replay.path_within)
    facts["path"] = fmt::format("the record is within {:g} mm of the run", to_mm(*replay.path_within));
  if (!replay.beads.empty()) {
    facts["beads"] =
        fmt::format("{} slices of {:.3f} s of the run, each seen from its end on; within {:g} mm", glb.slices,
                    glb.slice_time, to_mm(3.3 * replay.beads_within));
    facts["colours"] = glb.legend;
  }
  for (std::size_t i = 0; i < replay.shortfalls.size(); ++i)
    facts[fmt::format("note {}", i + 1)] = replay.shortfalls[i];
  glb.bytes = scene.glb(replay.title, facts);
  return glb;
}

}  // namespace understudy::report
