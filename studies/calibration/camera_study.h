// The table of docs/reference.md#two-cameras, regenerated: points in space from two cameras whose corners and
// targets are projected with noise, not drawn.
#pragma once

#include <functional>
#include <string>

#include "vision/boards/view_ray.h"

namespace understudy::studies {

struct CameraStudySetting {
  double pixel = 0.1;               ///< [px], 1 sigma of corners and targets in u and v
  vision::BoardTolerance boards{};  ///< how the boards are misplaced
  int draws = 400;                  ///< of boards and noise
  int points = 60;                  ///< a draw, within 25 mm of the middle
};

/// RMS of the 3D error [m] over draws and points. Lenses are bent by up to 8 px, focal lengths off by 0.4 %
/// and mounts by 0.7 mm and 4 mrad; the lenses' axes are known.
double camera_study(const CameraStudySetting& setting, vision::ViewRayMethod method, int threads = 1);

/// Five rows by three methods, the reference's figures in brackets; `line` gets each line without its end.
void camera_study_table(int draws, int threads, const std::function<void(const std::string&)>& line);

}  // namespace understudy::studies
