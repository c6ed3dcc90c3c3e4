// Private to this room: the calibrations behind calibrate_sight(), and how their input is perturbed.
#pragma once

#include "vision/boards/view_ray.h"

namespace understudy::vision {

std::shared_ptr<const SightModel> calibrate_layers(const CameraLayers& layers,
                                                   const CalibrationUncertainty& doubt, bool straight);
std::shared_ptr<const SightModel> calibrate_pinhole(const CameraLayers& layers,
                                                    const CalibrationUncertainty& doubt);

}  // namespace understudy::vision
