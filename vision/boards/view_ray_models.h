// Private to this room: the calibrations behind calibrate_view_rays(), and how their input is perturbed.
#pragma once

#include "vision/boards/view_ray.h"

namespace understudy::vision {

std::shared_ptr<const ViewRayModel> calibrate_layers(const CameraLayers& layers,
                                                     const CalibrationUncertainty& uncertainty,
                                                     bool straight);
std::shared_ptr<const ViewRayModel> calibrate_pinhole(const CameraLayers& layers,
                                                      const CalibrationUncertainty& uncertainty);

}  // namespace understudy::vision
