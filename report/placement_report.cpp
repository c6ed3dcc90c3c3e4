#include "report/placement_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using rehearsal::Placement;

Json limits_value(const Placement& placement) {
  Json list = Json::array();
  for (const rehearsal::LimitShare& limit : placement.limits) {
    Json value;
    value["limit"] = limit.name;
    value["share"] = stable_number(limit.share, "share");
    value["best"] = stable_number(limit.best, "best");
    value["counts"] = limit.counts;
    value["gcode_line"] = limit.line;
    list.push_back(value);
  }
  return list;
}

Json map_value(const rehearsal::PlacementMap& map) {
  Json value;
  value["x_mm"] = stable_number(map.x_mm, "x_mm");
  value["y_mm"] = stable_number(map.y_mm, "y_mm");
  value["x_step_mm"] = stable_number(map.x_step_mm, "x_step_mm");
  value["y_step_mm"] = stable_number(map.y_step_mm, "y_step_mm");
  value["columns"] = map.columns;
  value["rows"] = map.rows;
  value["margin"] = Json::array();
  for (const double margin : map.margin) value["margin"].push_back(stable_number(margin, "margin", 4));
  value["best_x_mm"] = stable_number(map.best_x_mm, "best_x_mm");
  value["best_y_mm"] = stable_number(map.best_y_mm, "best_y_mm");
  return value;
}

}  // namespace

std::string placement_text(const Placement& placement, const std::string& title) {
  std::string text;
  if (placement.possible)
    text = fmt::format("{}: margin {:.3f} ({}) with {}\n", title, placement.margin, placement.least,
                       rehearsal::place_words(placement.place));
  else
    text = fmt::format("{}: no place on the table holds every limit\n  the best, {}: {}\n", title,
                       rehearsal::place_words(placement.place), placement.reason);
  if (placement.margin_as_given)
    text += fmt::format("  margin as it is: {:.3f}\n", *placement.margin_as_given);
  for (const rehearsal::LimitShare& limit : placement.limits)
    text += fmt::format("  {:<24} {:>7.3f}   line {}{}\n", limit.name, limit.share, limit.line,
                        limit.counts ? "" : ", must only hold");
  return text + fmt::format("  {} poses checked, {} places looked at with {} of them\n", placement.poses,
                            placement.placements, placement.searched_poses);
}

std::string placement_json(const Placement& placement, const PlacementProvenance& provenance) {
  Json value;
  value["program"] = provenance.program;
  value["machine"] = provenance.machine;
  value["possible"] = placement.possible;
  if (!placement.possible) value["reason"] = placement.reason;
  const rehearsal::ProgramPlace& place = placement.place;
  value["place_mm"] = {stable_number(place.x_mm, "x", 9), stable_number(place.y_mm, "y", 9),
                       stable_number(place.z_mm, "z", 9)};
  value["turn_deg"] = stable_number(place.turn_deg, "turn");
  value["spin_deg"] = stable_number(place.spin_deg, "spin");
  value["options"] = rehearsal::place_words(place);
  value["margin"] = stable_number(placement.margin, "margin");
  value["least"] = placement.least;
  if (placement.margin_as_given)
    value["margin_as_given"] = stable_number(*placement.margin_as_given, "margin_as_given");
  value["limits"] = limits_value(placement);
  value["map"] = map_value(placement.map);
  value["poses"] = placement.poses;
  value["searched_poses"] = placement.searched_poses;
  value["placements"] = placement.placements;
  value["version"] = kVersion;
  value["command"] = provenance.command;
  return to_text(value, 2);
}

}  // namespace understudy::report
