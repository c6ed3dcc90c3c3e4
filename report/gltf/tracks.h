// Where nodes are along a run, with as few keys as a bound allows.
#pragma once

#include <vector>

#include "core/frames.h"
#include "report/gltf/gltf_scene.h"

namespace understudy::report {

/// Values at instants [s], which do not fall; between them straight, or along the shorter arc.
struct PlaceTrack {
  std::vector<double> times;
  std::vector<Vec3> places;  ///< [m]
};
struct TurnTrack {
  std::vector<double> times;
  std::vector<Quat> turns;
};

/// Fewer keys, of which the first and the last are among the given: at each given instant no more than
/// `error` off [m], [rad]. A track that does not move as far has one key, its last.
PlaceTrack thinned(const PlaceTrack& track, double error);
TurnTrack thinned(const TurnTrack& track, double error);

/// A node that goes through poses: no point within `reach` [m] of its origin is off by more than `within`
/// [m]. It stands where the last pose puts it. `speed`: so many times as fast as the run.
struct Motion {
  double within = 10e-6;
  double speed = 1;
  double reach = 0;
};
int add_moving_node(const std::string& name, int parent, const std::vector<double>& times,
                    const std::vector<Pose>& poses, const Motion& motion, GltfScene& scene);
/// The same of a node that is there already, and of its turns or places alone.
void animate_places(int node, PlaceTrack track, double error, double speed, GltfScene& scene);
void animate_turns(int node, TurnTrack track, double error, double speed, GltfScene& scene);

}  // namespace understudy::report
