// The machine along a run: what a replay is drawn from.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "geometry/shape.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/configuration.h"

namespace understudy::rehearsal {

/// A body of the machine and what carries it.
struct ReplayBody {
  enum class Carrier {
    world,  ///< stands still in W
    tool,   ///< rigid with T
    strut,  ///< a capsule from a point of W to a point of T
    axes,   ///< posed at every key
  };
  geometry::Shape shape;  ///< X_FS in W, in T, or of no meaning, by the carrier
  Carrier carrier = Carrier::world;
  Vec3 from_W{0, 0, 0}, to_T{0, 0, 0};  ///< [m], of a strut
  std::vector<Pose> X_WF;               ///< of a body that axes carry: one a key
};

struct Replay {
  std::vector<double> key_times;  ///< [s]
  std::vector<ReplayBody> bodies;
  std::vector<Pose>
      X_WO;             ///< the machine's frame, one a key, where axes move the table; empty where W stands
  std::string program;  ///< its file, as it was read; of a long one the beginning
  std::size_t program_left_out = 0;                   ///< [bytes] behind that
  std::vector<std::pair<int, std::string>> features;  ///< line from which on a feature type holds
};

/// Where the machine was at a time [s].
struct Moment {
  double time = 0;
  sim::Configuration configuration;
};

/// Bodies are posed at `keys` moments at most, evenly chosen, the last among them. Without moments there are
/// no bodies.
Replay make_replay(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                   const std::vector<Moment>& moments, std::size_t keys = 1500);

}  // namespace understudy::rehearsal
