// The description of a measuring set-up as a YAML file (docs/measuring-pictures.md), in mm, um, mrad and
// pixels.
#pragma once

#include <string>

#include "vision/boards/calibration_rig.h"
#include "vision/boards/picture_name.h"
#include "vision/boards/view_ray.h"

namespace understudy {
struct MapSchema;
}

namespace understudy::vision {

/// A set-up as its owner believes it to be, how well he knows it, and what its pictures are called.
struct RigDescription {
  std::string file;  ///< as it was named; patterns are relative to its folder
  CalibrationRig rig;
  CalibrationUncertainty uncertainty;  ///< boards, corner_px and principal_px are of the file
  PictureName board_pictures;          ///< of camera and layer
  PictureName pose_pictures;           ///< of pose and camera

  /// "boards/camera0-layer07.png" in the folder of the file.
  std::string board_picture(int camera, int layer) const;
};

/// The names that understudy itself gives to pictures.
PictureName board_picture_name(const std::string& pattern = "boards/camera{camera}-layer{layer:02}.png");
PictureName pose_picture_name(const std::string& pattern = "poses/pose-{pose:04}-camera{camera}.png");

/// Throws InputError with file, line and key.
RigDescription load_rig(const std::string& file);

/// What load_rig asks for.
MapSchema rig_schema();

/// The same file back, with `comment` as its first line.
std::string rig_yaml(const RigDescription& description, const std::string& comment);

}  // namespace understudy::vision
