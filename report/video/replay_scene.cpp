#include "report/video/replay_scene.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "report/picture/bead_surface.h"
#include "report/picture/body_colours.h"
#include "sim/surface/swept_shell.h"

namespace understudy::report {
namespace {

using rehearsal::ReplayBody;
using rehearsal::TracePoint;

constexpr std::size_t kPathPointsMost = 3000;    // of what is still to come
constexpr std::size_t kTrianglesMost = 600'000;  // of beads in one picture

constexpr double kShareLeast = 1e-6;  // of a section: less has no direction

/// The last key that is not later; the first for what is earlier.
std::size_t key_at(const std::vector<double>& times, double time) {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  return next == times.begin() ? 0 : static_cast<std::size_t>(next - times.begin()) - 1;
}

geometry::Shape posed(const ReplayBody& body, const Pose& X_WT, std::size_t key) {
  geometry::Shape shape = body.shape;
  switch (body.carrier) {
    case ReplayBody::Carrier::world:
      break;
    case ReplayBody::Carrier::tool:
      shape.X_FS = X_WT * body.shape.X_FS;
      break;
    case ReplayBody::Carrier::strut:
      if (const auto* capsule = std::get_if<geometry::Capsule>(&shape.form))
        shape = geometry::capsule_between(shape.name, body.from_W, X_WT * body.to_T, capsule->radius);
      break;
    case ReplayBody::Carrier::axes:
      if (!body.X_WF.empty()) shape.X_FS = body.X_WF[std::min(key, body.X_WF.size() - 1)];
      break;
  }
  return shape;
}

std::size_t triangles_of(const std::vector<sim::BeadStretch>& stretches, double error) {
  std::size_t count = 0;
  for (const auto& stretch : stretches)
    count += sim::sweep_size(stretch, sim::sides_within(stretch, error)).triangles;
  return count;
}

/// Coarser by a factor of three each time, until it is no more triangles than a picture can hold.
sim::SweptShell shells_of(const std::vector<sim::BeadStretch>& stretches, double error) {
  constexpr double kCoarsest = 300e-6;
  while (error < kCoarsest && triangles_of(stretches, error) > kTrianglesMost) error *= 3;
  sim::SweptShell shells;
  for (const auto& stretch : stretches) sim::append_whole(stretch, sim::sides_within(stretch, error), shells);
  return shells;
}

bool is_tip(const ReplayBody& body) {
  return body.shape.name == "nozzle" || body.shape.name == "heater block";
}

/// Of a tool without such bodies all that it carries.
std::vector<const ReplayBody*> bodies_of(const std::vector<ReplayBody>& all, ShownBodies shown) {
  const bool has_tip = std::ranges::any_of(all, is_tip);
  std::vector<const ReplayBody*> bodies;
  for (const ReplayBody& body : all)
    if (shown == ShownBodies::machine || (has_tip ? is_tip(body) : body.carrier == ReplayBody::Carrier::tool))
      bodies.push_back(&body);
  return bodies;
}

/// A polyline for each stretch that is still to be printed.
void add_path_to_come(const std::vector<TracePoint>& path, double time, double radius,
                      std::vector<renderer::Polyline>& polylines) {
  std::size_t points = 0;
  bool printing = false;
  for (const TracePoint& point : path) {
    const bool to_come = point.extruding && point.time >= time;
    if (to_come && ++points > kPathPointsMost) return;
    if (to_come && !printing) polylines.push_back({{}, kPath, radius});
    if (to_come) polylines.back().points.push_back(point.X_WT.translation());
    printing = to_come;
  }
}

}  // namespace

std::vector<sim::BeadStretch> laid_by(const std::vector<sim::BeadStretch>& beads, double time) {
  std::vector<sim::BeadStretch> laid;
  for (const sim::BeadStretch& stretch : beads) {
    const auto later = std::find_if(stretch.begin(), stretch.end(),
                                    [&](const sim::BeadSection& section) { return section.laid_at > time; });
    if (later == stretch.begin()) continue;
    sim::BeadStretch begun(stretch.begin(), later);
    if (later != stretch.end()) {
      const sim::BeadSection& last = *(later - 1);
      const double share = (time - last.laid_at) / (later->laid_at - last.laid_at);
      if (share > kShareLeast) begun.push_back(sim::section_between(last, *later, share));
    }
    laid.push_back(std::move(begun));
  }
  return laid;
}

Eigen::AlignedBox3d box_of_beads(const std::vector<sim::BeadStretch>& beads) {
  Eigen::AlignedBox3d box;
  for (const sim::BeadStretch& stretch : beads)
    for (const sim::BeadSection& section : stretch) box.extend(section.middle_W);
  return box;
}

Pose drawn_from_W(const RecordedReplay& replay, double time) {
  const auto& X_WO = replay.machine.X_WO;
  if (X_WO.empty()) return Pose::Identity();
  return X_WO[std::min(key_at(replay.machine.key_times, time), X_WO.size() - 1)].inverse(Eigen::Isometry);
}

Pose tool_at(const RecordedReplay& replay, double time) {
  const std::vector<TracePoint>& path = replay.path;
  const auto next =
      std::find_if(path.begin(), path.end(), [&](const TracePoint& p) { return p.time > time; });
  if (next == path.begin()) return path.front().X_WT;
  const TracePoint& before = *(next - 1);
  if (next == path.end()) return before.X_WT;
  const double share = (time - before.time) / (next->time - before.time);
  const Eigen::Quaterniond from(before.X_WT.linear()), to(next->X_WT.linear());
  return make_pose(from.slerp(share, to).toRotationMatrix(),
                   (1 - share) * before.X_WT.translation() + share * next->X_WT.translation());
}

renderer::PictureScene replay_scene(const RecordedReplay& replay, double time, double pixel,
                                    ShownBodies shown) {
  renderer::PictureScene drawn;
  const std::size_t key = key_at(replay.machine.key_times, time);
  const Pose X_WT = tool_at(replay, time);
  for (const ReplayBody* body : bodies_of(replay.machine.bodies, shown))
    drawn.shapes.push_back({posed(*body, X_WT, key), colour_of_body(body->shape.name)});
  if (replay.table) drawn.shapes.push_back({*replay.table, kTable});
  if (replay.part) drawn.shapes.push_back({{"part", geometry::MeshShape{replay.part}}, kPart});
  if (sim::SweptShell shells = shells_of(laid_by(replay.beads, time), pixel); !shells.mesh.triangles.empty())
    drawn.surfaces.push_back(bead_surface(std::move(shells)));
  add_path_to_come(replay.path, time, pixel, drawn.polylines);
  const Pose X_OW = drawn_from_W(replay, time);
  for (auto& shape : drawn.shapes) shape.shape.X_FS = X_OW * shape.shape.X_FS;
  for (auto& surface : drawn.surfaces) surface.X_WF = X_OW * surface.X_WF;
  for (auto& line : drawn.polylines)
    for (Vec3& point : line.points) point = X_OW * point;
  return drawn;
}

}  // namespace understudy::report
