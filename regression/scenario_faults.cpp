#include "regression/scenario_faults.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "core/yaml/yaml_map.h"

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

sim::CameraFaultKind read_camera_kind(YamlMap& map) {
  std::vector<std::string> words;
  for (int k = 0; k < sim::kCameraFaultKinds; ++k)
    words.emplace_back(to_string(static_cast<sim::CameraFaultKind>(k)));
  const std::string word = map.word("fault", words, "what goes wrong");
  map.require("fault");
  const auto found = std::find(words.begin(), words.end(), word) - words.begin();
  return static_cast<sim::CameraFaultKind>(found);
}

CameraFaultRequest read_camera_fault(YamlMap& map) {
  constexpr Bounds kOffset{-1000, 1000}, kTurn{-360, 360};
  CameraFaultRequest request;
  request.place = map.place();
  sim::CameraFaultEvent& event = request.event;
  event.kind = read_camera_kind(map);
  event.time = map.number("at_s", kNotNegative, "time of the print, from which on");
  if (map.has("share")) event.share = map.number("share", {0, 1}, "of the frames; else all");
  switch (event.kind) {
    case sim::CameraFaultKind::dim:
    case sim::CameraFaultKind::saturated:
      event.power = map.number("power", {0, 100}, "of the laser, of what it has by itself");
      break;
    case sim::CameraFaultKind::ghost:
      event.gap_offset =
          kMicrometre * map.number("gap_offset_um", {-5000, 5000}, "that it shows beyond the gap");
      break;
    case sim::CameraFaultKind::cut_beam:
    case sim::CameraFaultKind::strip:
      event.offset_px = map.number("offset_px", kOffset, "from the dot's centre to the edge");
      event.direction =
          from_deg(map.number("direction_deg", kTurn, "in which it is hidden, from the picture's x"));
      break;
    case sim::CameraFaultKind::displaced:
      event.offset_px = map.number("offset_px", kOffset, "along the picture's x");
      break;
    default:
      break;
  }
  return request;
}

}  // namespace

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
