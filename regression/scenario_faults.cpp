#include "regression/scenario_faults.h"

#include <fmt/format.h>

#include "core/units.h"
#include "core/yaml_map.h"

namespace understudy::regression {
namespace {

using namespace rehearsal;
using sim::FaultKind;

constexpr FaultKind kKinds[] = {FaultKind::lost_steps,  FaultKind::stall,          FaultKind::disconnected,
                                FaultKind::loose_joint, FaultKind::thermal_growth, FaultKind::power_cut};

FaultKind read_kind(YamlMap& map) {
  std::vector<std::string> words;
  for (const FaultKind kind : kKinds) words.push_back(to_string(kind));
  const std::string word = map.word("fault", words, "what goes wrong");
  map.require("fault");
  for (const FaultKind kind : kKinds)
    if (word == to_string(kind)) return kind;
  return FaultKind::stall;  // word() has thrown
}

constexpr int kMostSteps = 1'000'000;  // far beyond the travel of any drive
constexpr Bounds kNotNegative{0};

/// In um of a slide or arcmin of a turn.
void read_amount(YamlMap& map, const std::string& what, const char* about, FaultRequest& request) {
  request.angle = map.has(what + "_arcmin");
  const double value = map.number(what + (request.angle ? "_arcmin" : "_um"), {}, about);
  request.event.amount = request.angle ? from_deg(value / 60) : value * kMicrometre;
}

FaultRequest read_fault(YamlMap& map) {
  FaultRequest request;
  request.place = map.place();
  request.event.kind = read_kind(map);
  request.event.time = map.number("at_s", kNotNegative, "time of the print");
  if (request.event.kind != FaultKind::power_cut) request.axis = map.text("axis", "name of the axis");
  switch (request.event.kind) {
    case FaultKind::lost_steps:
      request.event.steps = map.integer("steps", 0, kMostSteps, "full steps, a positive multiple of 4");
      break;
    case FaultKind::stall:
      request.event.duration = map.number("for_s", kNotNegative, "how long the drive stands");
      break;
    case FaultKind::loose_joint:
      read_amount(map, "play", "by which the play grows", request);
      break;
    case FaultKind::thermal_growth:
      request.event.duration = map.number("over_s", kNotNegative, "how long it takes; 0: a step");
      read_amount(map, "growth", "of the axis beyond what its drive reads", request);
      break;
    default:
      break;
  }
  return request;
}

}  // namespace

std::vector<FaultRequest> read_faults(YamlMap& scenario) {
  std::vector<FaultRequest> requests;
  if (!scenario.has("faults")) return requests;
  scenario.list("faults", 0, "what goes wrong with the machine",
                [&](YamlMap& map, std::size_t) { requests.push_back(read_fault(map)); });
  return requests;
}

}  // namespace understudy::regression
