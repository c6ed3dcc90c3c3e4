// What a measuring set-up makes of its pictures: two calibrated cameras from boards, targets from where the
// tool was sent to (Song 2015, section 4 and appendix B). It does not matter where a picture comes from.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "vision/boards/stereo_pose.h"

namespace understudy::vision {

/// A measured board, in the order of Board::corner.
struct SeenBoard {
  int camera = 0;
  int layer = 0;
  std::vector<Vec2> corners_px;
};

/// Those of one camera, from near to far.
CameraLayers camera_layers(const CalibrationRig& rig, const std::vector<SeenBoard>& boards, int camera);

/// Throws as calibrate_stereo; boards may come in any order, and layers may be missing.
StereoModel calibrate_rig(const CalibrationRig& rig, const std::vector<SeenBoard>& boards,
                          ViewRayMethod method, const CalibrationUncertainty& uncertainty);

/// A part of one picture, in pixels of the sensor: rendered, read out or cut.
using ReadOut = std::function<Image(const Region&)>;

/// The radius that a target has in the picture at the middle distance [px].
double target_radius_px(const CalibrationRig& rig, int camera);

/// Where the designed camera has the targets [px], within +-1e5; a place far outside of the sensor where one
/// is behind the camera.
std::array<Vec2, 3> expected_targets(const CalibrationRig& rig, int camera, const Pose& X_WT);

/// Whether both cameras see all targets whole, even where the tool misses X_WT by 8 mm.
bool targets_in_view(const CalibrationRig& rig, const Pose& X_WT);

/// Looks for each target within 8 mm of where it is expected, then within 17 mm, never nearer to another
/// target's place. `read_out` is asked for the part that can show them, once or twice.
TargetsMeasurement find_targets(const CalibrationRig& rig, int camera, const Pose& X_WT_expected,
                                const ReadOut& read_out);

}  // namespace understudy::vision
