// The tables of `understudy measure board` and `understudy measure targets` (docs/measuring-pictures.md).
#pragma once

#include <string>
#include <vector>

#include "vision/boards/rig_file.h"
#include "vision/boards/rig_measurement.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::calibration {

/// Boards with all their corners. Throws InputError with file and line: columns that are missing or unknown,
/// a camera, layer or corner that the set-up has not, a corner given twice, a board that lacks one.
std::vector<vision::SeenBoard> read_corners(const std::string& file, const vision::CalibrationRig& rig);

/// The three targets of one pose in both pictures.
struct PoseTargets {
  int pose = 0;   ///< number of its pictures, from 1
  int line = 0;   ///< of the file, the first that names it
  int found = 0;  ///< of six; below, `targets` is not complete
  std::array<std::array<vision::PixelPoint, 3>, 2> targets;
};

/// By pose. Throws InputError likewise, and for a covariance that is not positive definite.
std::vector<PoseTargets> read_targets(const std::string& file);

}  // namespace understudy::calibration
