#include "regression/scenario_faults.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/strict_yaml.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using sim::FaultKind;

constexpr FaultKind kKinds[] = {FaultKind::lost_steps,  FaultKind::stall,          FaultKind::disconnected,
                                FaultKind::loose_joint, FaultKind::thermal_growth, FaultKind::power_cut};

FaultKind read_kind(StrictMap& map) {
  std::vector<std::string> words;
  for (const FaultKind kind : kKinds) words.push_back(to_string(kind));
  const std::string word = map.word("fault", words);
  for (const FaultKind kind : kKinds)
    if (word == to_string(kind)) return kind;
  return FaultKind::stall;  // word() has thrown
}

constexpr std::uint64_t kMostSteps = 1'000'000;  // far beyond the travel of any drive

double not_negative(StrictMap& map, const std::string& key) {
  const double value = map.number(key);
  if (value < 0) map.fail(key, fmt::format("{} is {}, below 0", key, value));
  return value;
}

int read_steps(StrictMap& map) {
  const std::uint64_t steps = map.whole_number("steps");
  if (steps > kMostSteps) map.fail("steps", fmt::format("steps is {}, above {}", steps, kMostSteps));
  return static_cast<int>(steps);
}

/// In um of a slide or arcmin of a turn.
void read_amount(StrictMap& map, const std::string& what, FaultRequest& request) {
  request.angle = map.has(what + "_arcmin");
  const double value = map.number(what + (request.angle ? "_arcmin" : "_um"));
  request.event.amount = request.angle ? from_deg(value / 60) : value * kMicrometre;
}

FaultRequest read_fault(StrictMap& map) {
  FaultRequest request;
  request.place = map.place();
  request.event.kind = read_kind(map);
  request.event.time = not_negative(map, "at_s");
  if (request.event.kind != FaultKind::power_cut) request.axis = map.text("axis");
  switch (request.event.kind) {
    case FaultKind::lost_steps:
      request.event.steps = read_steps(map);
      break;
    case FaultKind::stall:
      request.event.duration = not_negative(map, "for_s");
      break;
    case FaultKind::loose_joint:
      read_amount(map, "play", request);
      break;
    case FaultKind::thermal_growth:
      request.event.duration = not_negative(map, "over_s");
      read_amount(map, "growth", request);
      break;
    default:
      break;
  }
  map.close();
  return request;
}

}  // namespace

std::vector<FaultRequest> read_faults(StrictMap& scenario) {
  std::vector<FaultRequest> requests;
  if (!scenario.has("faults")) return requests;
  for (StrictMap& map : scenario.list_of_maps("faults", "a fault")) requests.push_back(read_fault(map));
  return requests;
}

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

}  // namespace understudy::rehearsal
