// The twin's microscope: what the camera beside the nozzle sees of the true machine.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/image.h"
#include "geometry/mesh.h"
#include "geometry/table_surface.h"
#include "machine/description.h"

namespace understudy::sim {

struct MicroscopeOptions {
  bool speckle = true;
  bool noise = true;
  geometry::TableSurface table = {};  ///< in W
};

/// Owns an OSMesa context; use from the thread that made it. Several may live in several threads.
class Microscope {
 public:
  /// `part` may be null: nothing but the table of `options`. The seed is that of the surface's roughness and
  /// of the noise.
  Microscope(const machine::MachineDescription& machine, std::shared_ptr<const geometry::Mesh> part,
             std::uint64_t seed, const MicroscopeOptions& options = {});
  ~Microscope();

  /// Beads near the tool, in W, from the next exposure on; nullptr: nothing is printed there.
  void set_printed(std::shared_ptr<const geometry::Mesh> beads);

  /// One exposure with the tool at its true pose. `region` is clipped to the sensor. Equal arguments, equal
  /// bytes. Throws MachineError when the renderer fails.
  Image expose(const Pose& X_WT_true, const Region& region, std::uint64_t frame_number);

  /// Where the centre of the dot truly is [px]; nothing when it is hidden or out of view. For observers only.
  std::optional<Vec2> true_dot(const Pose& X_WT_true) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
