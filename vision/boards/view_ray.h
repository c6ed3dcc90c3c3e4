// From a pixel to the line in space that is seen there (Song 2015, appendix B).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vision/boards/calibration_rig.h"

namespace understudy::vision {

/// A view ray in W: two points or more, away from the camera. Beyond its ends it goes on along its chord.
struct ViewRay {
  std::vector<Vec3> points;
};

struct Approach {
  Vec3 point{0, 0, 0};  ///< in W, halfway between the two lines
  double gap = 0;       ///< [m], between the two lines
  double beyond = 0;    ///< [m], how far beyond the ends of a line, the worse of both
};

/// Where two view rays are closest (Song 2015, appendix B.2: over all pairs of segments).
Approach closest_approach(const ViewRay& a, const ViewRay& b);

/// The corners of the board in one layer: where it is believed to be and where they were seen.
struct BoardLayer {
  Pose X_WG = Pose::Identity();
  std::vector<Vec2> corners_px;  ///< in the order of Board::corner
};

struct CameraLayers {
  MountedCamera camera;  ///< as designed: start of the pinhole's calibration; the other methods do not use it
  Board board;
  std::vector<BoardLayer> layers;  ///< from near to far
};

/// What a calibration cannot know of itself: standard deviations of its input, for the covariance; the
/// pinhole weighs its input by them as well.
struct CalibrationUncertainty {
  BoardTolerance boards{};
  double corner_px = 0;     ///< of a corner in u and v
  double principal_px = 0;  ///< of the designed principal point (pinhole only); 0: it is not known
  int replicas = 48;        ///< calibrations from perturbed input; 0 leaves the calibration's share out
  std::uint64_t seed = 1;   ///< of the perturbations
};

enum class ViewRayMethod {
  layer_polyline,  ///< the paper's: bilinear in each layer, the points joined
  layer_line,  ///< the same points, a straight line fitted: light in air is straight whatever the lens does
  pinhole,     ///< pinhole with Brown distortion, fitted to all layers at once,
               ///< each board free to be off its place within the uncertainty
};
const char* to_string(ViewRayMethod m);

/// A calibrated camera. Replica r of `replicas` is the same calibration from input perturbed within the
/// uncertainty; replica r of the two cameras of a set-up are independent when their seeds differ.
class ViewRayModel {
 public:
  static constexpr int kAsCalibrated = -1;
  virtual ~ViewRayModel() = default;
  virtual ViewRay view_ray(const Vec2& pixel, int replica) const = 0;
  virtual int replicas() const = 0;
  /// [px] RMS of the corners about the model, where the model does not pass through them by construction.
  virtual double residual_px() const { return 0; }
};

/// Throws InputError: fewer than two layers, corners missing or not finite, a pinhole that does not fit.
std::shared_ptr<const ViewRayModel> calibrate_view_rays(ViewRayMethod method, const CameraLayers& layers,
                                                        const CalibrationUncertainty& uncertainty);

}  // namespace understudy::vision
