// The `faults` and `camera_faults` of a scenario file.
#pragma once

#include <vector>

#include "core/yaml/yaml_map.h"
#include "rehearsal/request/fault_request.h"

namespace understudy::regression {

/// The list under `faults`. Throws InputError with file and line.
std::vector<rehearsal::FaultRequest> read_faults(YamlMap& scenario);
/// Likewise, under `camera_faults`.
std::vector<rehearsal::CameraFaultRequest> read_camera_faults(YamlMap& scenario);

}  // namespace understudy::regression
