#include "rehearsal/replay.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rehearsal/scene.h"
#include "sim/collision/chain_bodies.h"

namespace understudy::rehearsal {
namespace {

constexpr double kStill =
    1e-7;  // [m] and of a rotation's entries: rounding of poses, a thousandth of a pixel

bool same(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() < kStill; }

/// Whether a body has the same pose in a frame at every key.
template <typename PoseAt>
bool still(std::size_t keys, const PoseAt& pose_at) {
  for (std::size_t k = 1; k < keys; ++k)
    if (!same(pose_at(k), pose_at(0))) return false;
  return true;
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t kept = std::min(count, most);
  for (std::size_t k = 0; k < kept; ++k)
    chosen.push_back(kept > 1 ? k * (count - 1) / (kept - 1) : count - 1);
  return chosen;
}

/// The ends of a capsule in W.
std::pair<Vec3, Vec3> ends_of(const geometry::Capsule& capsule, const Pose& X_WF) {
  const Vec3 half = 0.5 * capsule.length * X_WF.linear().col(2);
  return {X_WF.translation() - half, X_WF.translation() + half};
}

/// One body at every key, as machine_scene() posed it.
struct Track {
  std::vector<geometry::Shape> shapes;
  std::vector<Pose> X_WT;

  /// A capsule whose one end stands in W and whose other end stands in T.
  std::optional<ReplayBody> as_strut() const {
    std::vector<std::pair<Vec3, Vec3>> ends;
    for (const geometry::Shape& shape : shapes) {
      const auto* capsule = std::get_if<geometry::Capsule>(&shape.form);
      if (!capsule) return std::nullopt;
      ends.push_back(ends_of(*capsule, shape.X_FS));
    }
    ReplayBody body{
        shapes.front(), ReplayBody::Carrier::strut, ends[0].first, X_WT[0].inverse() * ends[0].second, {}};
    for (std::size_t k = 1; k < ends.size(); ++k)
      if ((ends[k].first - body.from_W).norm() > kStill ||
          (X_WT[k].inverse() * ends[k].second - body.to_T).norm() > kStill)
        return std::nullopt;
    return body;
  }

  ReplayBody carried_by(ReplayBody::Carrier carrier) const {
    return {shapes.front(), carrier, Vec3::Zero(), Vec3::Zero(), {}};
  }

  ReplayBody body() const {
    const std::size_t keys = shapes.size();
    if (still(keys, [&](std::size_t k) { return shapes[k].X_FS; }))
      return carried_by(ReplayBody::Carrier::world);
    const auto in_tool = [&](std::size_t k) { return Pose(X_WT[k].inverse() * shapes[k].X_FS); };
    if (still(keys, in_tool)) {
      ReplayBody body = carried_by(ReplayBody::Carrier::tool);
      body.shape.X_FS = in_tool(0);
      return body;
    }
    if (auto strut = as_strut()) return *strut;
    ReplayBody body = carried_by(ReplayBody::Carrier::axes);
    for (const geometry::Shape& shape : shapes) body.X_WF.push_back(shape.X_FS);
    return body;
  }
};

}  // namespace

Replay make_replay(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                   const std::vector<Moment>& moments, std::size_t keys) {
  Replay replay;
  std::vector<Track> tracks;
  sim::ChainBodies chain(machine, as_built);
  for (const std::size_t i : evenly(moments.size(), keys)) {
    const sim::Configuration& configuration = moments[i].configuration;
    replay.key_times.push_back(moments[i].time);
    std::vector<geometry::Shape> bodies = machine_scene(machine, as_built, configuration).bodies;
    tracks.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      tracks[b].shapes.push_back(std::move(bodies[b]));
      tracks[b].X_WT.push_back(configuration.X_WT);
    }
    if (machine.is_chain()) {
      chain.pose(configuration.axes);
      replay.X_WO.push_back(chain.X_WO());
    }
  }
  for (const Track& track : tracks) replay.bodies.push_back(track.body());
  if (still(replay.X_WO.size(), [&](std::size_t k) { return replay.X_WO[k]; })) replay.X_WO.clear();
  return replay;
}

}  // namespace understudy::rehearsal
