#include "report/gltf/tracks.h"

#include <algorithm>
#include <cmath>

#include "report/trace/kept_points.h"

namespace understudy::report {
namespace {

constexpr std::size_t kMost = 256;  // keys that one stands for

double share_at(const std::vector<double>& times, std::size_t a, std::size_t i, std::size_t b) {
  const double span = times[b] - times[a];
  return span > 0 ? (times[i] - times[a]) / span : 0;
}

/// `off(a, i, b)`: how far the value between those at a and b is off that at i.
template <typename Off>
std::vector<std::size_t> keys_within(std::size_t count, double error, const Off& off) {
  std::size_t still = 0;
  while (still < count && off(count - 1, still, count - 1) <= error) ++still;
  if (still == count && count > 0) return {count - 1};
  return kept_points(count, kMost, [&](std::size_t a, std::size_t b) {
    for (std::size_t i = a + 1; i < b; ++i)
      if (off(a, i, b) > error) return false;
    return true;
  });
}

}  // namespace

PlaceTrack thinned(const PlaceTrack& track, double error) {
  const auto off = [&](std::size_t a, std::size_t i, std::size_t b) {
    const Vec3 there = track.places[a] + share_at(track.times, a, i, b) * (track.places[b] - track.places[a]);
    return (track.places[i] - there).norm();
  };
  PlaceTrack kept;
  for (const std::size_t i : keys_within(track.times.size(), error, off)) {
    kept.times.push_back(track.times[i]);
    kept.places.push_back(track.places[i]);
  }
  return kept;
}

TurnTrack thinned(const TurnTrack& track, double error) {
  const auto off = [&](std::size_t a, std::size_t i, std::size_t b) {
    const Quat there = track.turns[a].slerp(share_at(track.times, a, i, b), track.turns[b]);
    return there.angularDistance(track.turns[i]);
  };
  TurnTrack kept;
  for (const std::size_t i : keys_within(track.times.size(), error, off)) {
    kept.times.push_back(track.times[i]);
    kept.turns.push_back(track.turns[i]);
  }
  return kept;
}

void animate_places(int node, PlaceTrack track, double error, double speed, GltfScene& scene) {
  track = thinned(track, error);
  for (double& time : track.times) time /= speed;
  scene.animate_translation(node, track.times, track.places);
}

void animate_turns(int node, TurnTrack track, double error, double speed, GltfScene& scene) {
  track = thinned(track, error);
  for (double& time : track.times) time /= speed;
  scene.animate_rotation(node, track.times, track.turns);
}

int add_moving_node(const std::string& name, int parent, const std::vector<double>& times,
                    const std::vector<Pose>& poses, const Motion& motion, GltfScene& scene) {
  PlaceTrack places{times, {}};
  TurnTrack turns{times, {}};
  for (const Pose& X : poses) {
    places.places.emplace_back(X.translation());
    turns.turns.emplace_back(X.linear());
  }
  const int node = scene.node(name, parent, poses.back());
  // Half of the bound each. A reach of a micrometre stands for bodies that are a point.
  animate_places(node, std::move(places), motion.within / 2, motion.speed, scene);
  animate_turns(node, std::move(turns), motion.within / 2 / std::max(motion.reach, 1e-6), motion.speed,
                scene);
  return node;
}

}  // namespace understudy::report
