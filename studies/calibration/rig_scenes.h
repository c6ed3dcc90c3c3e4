// A built measuring set-up and what its cameras see. The renderer knows no set-up and the set-up no renderer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/calibration_view.h"
#include "vision/boards/calibration_rig.h"

namespace understudy::studies {

/// The truth behind a CalibrationRig, which is what a controller believes: the cameras as they are mounted,
/// how far each board is from where the designed rig has it, and how it was printed.
struct BuiltRig {
  std::array<vision::MountedCamera, 2> cameras;
  std::array<std::vector<vision::BoardPlacement>, 2> boards;  ///< of each camera, layer by layer
  std::array<vision::PrintError, 2> prints;                   ///< of the board before each camera
};

/// A set-up that was built as designed.
BuiltRig built_as_designed(const vision::CalibrationRig& designed);

/// A set-up as workshops build it: lenses with 2 to 8 px of distortion at the picture's edge, focal lengths
/// off by 0.3 %, principal points by `principal_px` [px], mounts by 0.3 mm and 2 mrad (1 sigma each), and
/// boards by `boards`. Equal seeds give equal set-ups.
BuiltRig sample_built_rig(const vision::CalibrationRig& designed, const vision::BoardTolerance& boards,
                          double principal_px, std::uint64_t seed);

/// The board that `camera` sees in `layer`. It stands where the designed rig says, but for its placement, not
/// where the mounted camera looks.
renderer::BoardScene board_scene(const vision::CalibrationRig& designed, const BuiltRig& built, int camera,
                                 int layer);

/// The three targets of a tool at its true pose.
renderer::TargetScene target_scene(const vision::CalibrationRig& designed, const BuiltRig& built, int camera,
                                   const Pose& X_WT);

}  // namespace understudy::studies
