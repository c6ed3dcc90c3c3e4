// A fault as scenario files and `--fault` have it: {fault: stall, axis: l3, at_s: 4.15, for_s: 0.4}
// (docs/faults.md).
#pragma once

#include <string>
#include <vector>

#include "core/yaml/yaml_map.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// The words of `fault`, in the order of their kinds: of the machine, and of its gap sensor.
const std::vector<std::string>& machine_fault_words();
const std::vector<std::string>& camera_fault_words();

/// One entry of a list of faults. Throws InputError with file and line.
FaultRequest read_fault(YamlMap& map);
CameraFaultRequest read_camera_fault(YamlMap& map);

/// Adds the fault that `words` tell, of the machine or of its gap sensor; the braces may be left out. Throws
/// InputError, its place `--fault`.
void add_fault(const std::string& words, RehearsalRequest& request);

}  // namespace understudy::rehearsal
