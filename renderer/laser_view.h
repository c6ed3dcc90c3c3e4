// What the tool's microscope sees: the part's surface, the nozzle, the laser dot with speckle; noise, 8 bits.
// The renderer knows the true poses; whoever measures the picture must not.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image.h"
#include "geometry/mesh.h"
#include "geometry/shape.h"
#include "geometry/table_surface.h"

namespace understudy::renderer {

struct LaserScene {
  std::shared_ptr<const geometry::Mesh> part;     ///< may be null: nothing but the table
  std::shared_ptr<const geometry::Mesh> printed;  ///< beads near the tool, in W; may be null
  bool table = true;                              ///< there is one
  geometry::TableSurface table_top;               ///< in W; its tangent plane below the tip is drawn
  std::vector<geometry::Shape> tool_bodies;       ///< in T; they occlude beam and view
  Pose X_WT = Pose::Identity();                   ///< true pose
  Pose X_TC = Pose::Identity();
  Pose X_TL = Pose::Identity();
  Camera camera;
  double waist_diameter = 0;  ///< [m], 1/e^2
  double wavelength = 0;      ///< [m]
  double peak_level = 0;      ///< grey levels
  double ambient_level = 0;   ///< grey levels
  double aperture_sine = 0;
  double blur_px = 0;
  double full_well = 0;   ///< [electrons] at 255
  double read_noise = 0;  ///< [electrons]
  bool speckle = true;
  bool noise = true;
  std::uint64_t seed = 0;   ///< of the surface's roughness: speckle is frozen to the surface
  std::uint64_t frame = 0;  ///< of shot and read noise
};

/// Owns an OSMesa context; use from one thread. Throws MachineError when no context can be made.
class LaserView {
 public:
  LaserView();
  ~LaserView();
  /// Grey 8-bit picture of `region` (clipped to the sensor). Equal scenes give equal bytes.
  Image render(const LaserScene& scene, const Region& region);

 private:
  friend void keep_laser_views();
  struct State;
  struct Kept;
  std::unique_ptr<State> state_;
};

/// From now on the last view that goes on this thread leaves its context, programs and textures to the next
/// one, which draws the same pictures: for processes that rehearse again and again.
void keep_laser_views();

/// True centre of the dot: where the beam's axis meets part, table or tool, projected. False: out of view or
/// hidden from the camera.
bool true_dot(const LaserScene& scene, Vec2& pixel);

}  // namespace understudy::renderer
