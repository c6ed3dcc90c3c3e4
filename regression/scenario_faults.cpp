#include "regression/scenario_faults.h"

#include <fmt/format.h>

#include "core/strict_yaml.h"
#include "core/units.h"

namespace understudy::regression {
namespace {

using namespace rehearsal;
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

}  // namespace understudy::regression
