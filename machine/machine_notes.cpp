#include "machine/machine_notes.h"

#include <array>
#include <string_view>
#include <utility>

namespace understudy::machine {

const std::vector<Assumption>& assumptions() {
  static const std::vector<Assumption> all{
      {"dimensions", "where the tip is, and so every gap and clearance"},
      {"place", "which poses can be reached, and the clearance to the table"},
      {"ranges", "which poses can be reached"},
      {kAssumedMasses, "loads of the drives, and on which side of its play an axis rests"},
      {"home", "the way to the first point"},
      {"drives", "print time, and how far axes fall behind"},
      {"play", "errors of the tip, and the gap"},
      {"tolerances", "errors of the tip of the machine as it was built, and the gap"},
      {"tool", "collisions, the width of beads and the flow"},
      {"optics", "what gap control sees"},
      {"motion", "print time"},
  };
  return all;
}

std::vector<std::string> assumption_words() {
  std::vector<std::string> words;
  for (const Assumption& assumption : assumptions()) words.emplace_back(assumption.word);
  return words;
}

std::string assumption_of(const std::string& path) {
  // The first beginning that fits; a longer one stands before it.
  constexpr std::array<std::pair<std::string_view, const char*>, 29> kBeginnings{{
      {"geometry.base_mm", "place"},
      {"geometry.base_turn_deg", "place"},
      {"geometry.base_link", ""},
      {"geometry.tip_mm", "tool"},
      {"geometry.tool_direction", "tool"},
      {"geometry.tool_link", ""},
      {"geometry.tool_carried_by", ""},
      {"geometry.work_carried_by", ""},
      {"geometry.urdf", ""},
      {"geometry.srdf", ""},
      {"geometry.packages", ""},
      {"geometry.unchecked_links", ""},
      {"geometry.", "dimensions"},
      {"joints.", "ranges"},
      {"limits.", "ranges"},
      {"axes.range", "ranges"},
      {"axes.endless", "ranges"},
      {"axes.home", "home"},
      {"axes.drive.", "drives"},
      {"axes.play", "play"},
      {"axes.friction", "play"},
      {"axes.link.", "masses"},
      {"axes.point_mm", "dimensions"},
      {"axes.direction", "dimensions"},
      {"drive.", "drives"},
      {"play.", "play"},
      {"masses.", "masses"},
      {"tool.", "tool"},
      {"tolerances.", "tolerances"},
  }};
  for (const auto& [beginning, word] : kBeginnings)
    if (std::string_view(path).starts_with(beginning)) return word;
  if (path.starts_with("laser.") || path.starts_with("microscope.")) return "optics";
  return path.starts_with("motion.") ? "motion" : "";
}

}  // namespace understudy::machine
