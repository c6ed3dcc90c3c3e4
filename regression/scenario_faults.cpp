#include "regression/scenario_faults.h"

#include "rehearsal/request/fault_words.h"

namespace understudy::regression {

using namespace rehearsal;

std::vector<CameraFaultRequest> read_camera_faults(YamlMap& scenario) {
  std::vector<CameraFaultRequest> requests;
  if (!scenario.has("camera_faults")) return requests;
  scenario.list("camera_faults", 0, "what goes wrong with the gap sensor",
                [&](YamlMap& map, std::size_t) { requests.push_back(read_camera_fault(map)); });
  return requests;
}

std::vector<FaultRequest> read_faults(YamlMap& scenario) {
  std::vector<FaultRequest> requests;
  if (!scenario.has("faults")) return requests;
  scenario.list("faults", 0, "what goes wrong with the machine",
                [&](YamlMap& map, std::size_t) { requests.push_back(read_fault(map)); });
  return requests;
}

}  // namespace understudy::regression
