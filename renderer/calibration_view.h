// What a calibration camera sees (Song 2015, section 4 and appendix B): the printed chessboard at a layer, or
// the spheres on the moving platform against a lit backdrop. The renderer knows the true places; whoever
// measures the picture must not.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/image.h"

namespace understudy::renderer {

/// From light to grey levels. Both views fall off with the fourth power of the cosine from the lens's axis.
struct Exposure {
  double gain = 200;         ///< grey levels of white in the middle of the picture; above 255: clipped
  double ambient_level = 8;  ///< grey levels of stray light
  double blur_px = 0.7;      ///< [px] 1 sigma of the optics, in 0.3 .. 10
  double full_well = 10000;  ///< [electrons] at 255
  double read_noise = 10;    ///< [electrons]
  bool noise = true;
  std::uint64_t seed = 0, frame = 0;  ///< of shot and read noise
};

/// A chessboard as it was printed and stands. Frame G: origin in the middle of the inner corners, x along a
/// row to the right, y down, z away from the camera.
struct BoardScene {
  Camera camera;
  Exposure exposure;
  int columns = 0, rows = 0;  ///< of inner corners
  double square = 0;          ///< [m], side
  double margin = 0;          ///< [m] of white paper around the squares
  /// [m], the sheet's z: b_0 X^2 + b_1 X Y + b_2 Y^2, X and Y 1 at the farthest corners. Small beside a
  /// square.
  Vec3 bow{0, 0, 0};
  Pose X_CG = Pose::Identity();  ///< of the sheet, camera frame
  double ink = 0.1;              ///< reflectance; paper has 1
  double background = 0.3;       ///< reflectance of what is behind the sheet
};

struct TargetScene {
  Camera camera;
  Exposure exposure;
  std::vector<Vec3> centres_C;  ///< [m], at most 8, each farther from the camera than twice the radius
  double radius = 0;            ///< [m]
  double albedo = 0.15;         ///< of the spheres, lit from above; the backdrop has 1
};

/// Owns an OSMesa context; use from one thread. Throws MachineError when no context can be made, InputError
/// for a scene that has no picture. Each pixel is the mean of a picture whose edges are blurred in closed
/// form, over 2 x 2 Gauss points: exact to the third order inside a pixel.
class CalibrationView {
 public:
  CalibrationView();
  ~CalibrationView();
  /// Grey 8-bit picture of `region` (clipped to the sensor). Equal scenes give equal bytes, and a pixel does
  /// not depend on the region it is read out with.
  Image render(const BoardScene& scene, const Region& region);
  Image render(const TargetScene& scene, const Region& region);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// True pixels of the board's inner corners, row by row from the upper left; nothing for those behind the
/// camera. Those outside the sensor are reported as well.
std::vector<std::optional<Vec2>> true_corners(const BoardScene& scene);

/// Where a sphere's centre is projected to, and the centre of the ellipse that its outline draws: they
/// differ, by 0.1 px at the edge of the picture. Lens distortion is applied to either.
std::optional<Vec2> true_sphere_centre(const Camera& camera, const Vec3& centre_C);
std::optional<Vec2> true_outline_centre(const Camera& camera, const Vec3& centre_C, double radius);

/// The smallest part of the sensor that shows all spheres with `margin_px` around them.
Region region_of_targets(const TargetScene& scene, int margin_px);

}  // namespace understudy::renderer
