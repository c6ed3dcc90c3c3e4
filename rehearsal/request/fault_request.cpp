#include "rehearsal/request/fault_request.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace understudy::rehearsal {

std::vector<sim::FaultEvent> resolve_faults(const std::vector<FaultRequest>& requests,
                                            const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  std::vector<std::string> names;
  for (int i = 0; i < mechanism->axis_count(); ++i) names.push_back(mechanism->axis_name(i));
  std::vector<sim::FaultEvent> events;
  for (const FaultRequest& request : requests) {
    sim::FaultEvent event = request.event;
    if (!request.axis.empty()) {
      const auto found = std::find(names.begin(), names.end(), request.axis);
      if (found == names.end())
        throw InputError(request.place, fmt::format("axis '{}' is not one of {}'s: {}", request.axis,
                                                    machine.name, fmt::join(names, ", ")));
      event.axis = static_cast<int>(found - names.begin());
      if (event.amount != 0 && request.angle != mechanism->axis_is_angle(event.axis))
        throw InputError(request.place,
                         fmt::format("axis '{}' {}: its amount is in {}", request.axis,
                                     request.angle ? "slides" : "turns", request.angle ? "um" : "arcmin"));
    }
    try {
      sim::check_faults({event}, machine);
    } catch (const InputError& error) {
      throw InputError(request.place, error.what());
    }
    events.push_back(event);
  }
  return events;
}

std::vector<sim::CameraFaultEvent> resolve_camera_faults(const std::vector<CameraFaultRequest>& requests,
                                                         const machine::MachineDescription& machine) {
  std::vector<sim::CameraFaultEvent> events;
  for (const CameraFaultRequest& request : requests) {
    if (!machine.has_microscope)
      throw InputError(request.place, fmt::format("camera fault {}: {} has no camera",
                                                  to_string(request.event.kind), machine.name));
    try {
      sim::check_camera_faults({request.event});
    } catch (const InputError& error) {
      throw InputError(request.place, error.what());
    }
    events.push_back(request.event);
  }
  return events;
}

}  // namespace understudy::rehearsal
