// Private to this room: the calibrations behind calibrate_sight(), and how their input is perturbed.
#pragma once

#include "vision/sight.h"

namespace understudy::vision {

std::shared_ptr<const SightModel> calibrate_layers(const CameraLayers& layers, const CalibrationDoubt& doubt,
                                                   bool straight);
std::shared_ptr<const SightModel> calibrate_pinhole(const CameraLayers& layers,
                                                    const CalibrationDoubt& doubt);

}  // namespace understudy::vision
