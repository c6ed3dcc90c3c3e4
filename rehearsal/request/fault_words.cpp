#include "rehearsal/request/fault_words.h"

#include <algorithm>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using sim::FaultKind;

constexpr FaultKind kKinds[] = {FaultKind::lost_steps,  FaultKind::stall,          FaultKind::disconnected,
                                FaultKind::loose_joint, FaultKind::thermal_growth, FaultKind::power_cut};

FaultKind read_kind(YamlMap& map) {
  const std::string word = map.word("fault", machine_fault_words(), "what goes wrong");
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

sim::CameraFaultKind read_camera_kind(YamlMap& map) {
  const std::vector<std::string>& words = camera_fault_words();
  const std::string word = map.word("fault", words, "what goes wrong");
  map.require("fault");
  const auto found = std::find(words.begin(), words.end(), word) - words.begin();
  return static_cast<sim::CameraFaultKind>(found);
}

}  // namespace

const std::vector<std::string>& machine_fault_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const FaultKind kind : kKinds) all.emplace_back(to_string(kind));
    return all;
  }();
  return words;
}

const std::vector<std::string>& camera_fault_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (int k = 0; k < sim::kCameraFaultKinds; ++k)
      all.emplace_back(to_string(static_cast<sim::CameraFaultKind>(k)));
    return all;
  }();
  return words;
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

void add_fault(const std::string& words, RehearsalRequest& request) {
  const bool whole = words.starts_with('{');
  YamlMap::read_text(whole ? words : "{" + words + "}", "--fault", [&](YamlMap& map) {
    std::vector<std::string> all = machine_fault_words();
    const std::vector<std::string>& of_camera = camera_fault_words();
    all.insert(all.end(), of_camera.begin(), of_camera.end());
    const std::string word = map.word("fault", all, "what goes wrong");
    map.require("fault");
    if (std::find(of_camera.begin(), of_camera.end(), word) != of_camera.end())
      request.camera_faults.push_back(read_camera_fault(map));
    else
      request.faults.push_back(read_fault(map));
  });
}

}  // namespace understudy::rehearsal
