#include "report/workspace_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "core/yaml/file_unit.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using kinematics::PointBox;
using kinematics::Workspace;
using kinematics::WorkspaceLimit;
using studies::WorkspaceStudy;

Json numbers(std::initializer_list<double> values) {
  Json list = Json::array();
  for (const double v : values)  // to 1e-9 mm: a sum that should be 0 says so
    list.push_back(stable_number(std::round(1e9 * v) / 1e9, "workspace"));
  return list;
}

Json millimetres(const Vec3& v) { return numbers({to_mm(v.x()), to_mm(v.y()), to_mm(v.z())}); }

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::int64_t failing(const Workspace& w) { return static_cast<std::int64_t>(w.binding.size()) - w.reachable; }

Json limit_value(const Workspace& w, const WorkspaceLimit& limit) {
  Json value;
  value["limit"] = studies::limit_text(limit);
  value["kind"] = to_string(limit.kind);
  value["part"] = limit.part;
  if (!limit.unit.empty()) {
    const FileUnit unit = file_unit(limit.unit);
    value["side"] = limit.above ? "above" : "below";
    value["value"] = stable_number(unit.factor * limit.limit, "limit");
    value["unit"] = unit.name;
  }
  value["binds_first"] = stable_number(share(limit.binds, failing(w)), "binds_first");
  value["broken"] = stable_number(share(limit.broken, failing(w)), "broken");
  const auto all = static_cast<std::int64_t>(w.binding.size());
  value["opens_alone"] = stable_number(share(limit.alone, all), "opens_alone");
  return value;
}

Json limits_value(const Workspace& w, const std::vector<WorkspaceLimit>& limits) {
  Json list = Json::array();
  for (const WorkspaceLimit& limit : limits) list.push_back(limit_value(w, limit));
  return list;
}

struct Corners {
  Vec3 lower, upper;  ///< [m], outermost points
};

Corners corners(const Workspace& w, const PointBox& box) {
  return {w.grid.point(box.first[0], box.first[1], box.first[2]),
          w.grid.point(box.last[0], box.last[1], box.last[2])};
}

Json box_value(const Workspace& w, const PointBox& box) {
  const auto [lower, upper] = corners(w, box);
  Json value;
  value["lower_mm"] = millimetres(lower);
  value["upper_mm"] = millimetres(upper);
  value["size_mm"] = millimetres(upper - lower);
  return value;
}

Json quantiles_value(const std::vector<double>& quantiles) {
  static constexpr const char* kNames[] = {"min", "p05", "median", "p95", "max"};
  Json value;
  for (std::size_t i = 0; i < quantiles.size(); ++i)
    value[kNames[i]] = stable_number(quantiles[i], kNames[i]);
  return value;
}

Json axes_value(const WorkspaceStudy& study) {
  Json list = Json::array();
  const auto mechanism = study.machine.make_mechanism();
  for (std::size_t i = 0; i < study.workspace.axes.size(); ++i) {
    const int axis = static_cast<int>(i);
    const FileUnit unit = file_unit(mechanism->axis_is_angle(axis) ? "rad" : "m");
    const auto [lower, upper] = mechanism->axis_range(axis);
    const auto use = study.workspace.axes[i];
    Json value;
    value["name"] = mechanism->axis_name(axis);
    value["unit"] = unit.name;
    value["used"] = numbers({unit.factor * use.lowest, unit.factor * use.highest});
    if (std::isfinite(lower) && std::isfinite(upper)) {
      value["range"] = numbers({unit.factor * lower, unit.factor * upper});
      value["margin"] =
          stable_number(unit.factor * std::min(use.lowest - lower, upper - use.highest), "margin");
    }
    list.push_back(value);
  }
  return list;
}

Json grid_value(const Workspace& w) {
  const auto cells = w.grid.cells();
  Json grid;
  for (int i = 0; i < 3; ++i)
    grid["box_mm"][std::string(1, "xyz"[i])] = numbers({to_mm(w.grid.lower[i]), to_mm(w.grid.upper[i])});
  grid["step_mm"] = stable_number(to_mm(w.grid.step), "step");
  grid["cells"] = cells;
  grid["points"] = w.grid.size();
  return grid;
}

std::string box_line(const char* name, const Workspace& w, const std::optional<PointBox>& box) {
  if (!box) return fmt::format("{:<14} none\n", name);
  const auto [lower, upper] = corners(w, *box);
  const Vec3 size = upper - lower;
  return fmt::format(
      "{:<14} {:.1f} x {:.1f} x {:.1f} mm, x {:.1f}..{:.1f}, y {:.1f}..{:.1f}, z {:.1f}..{:.1f}\n", name,
      to_mm(size.x()), to_mm(size.y()), to_mm(size.z()), to_mm(lower.x()), to_mm(upper.x()), to_mm(lower.y()),
      to_mm(upper.y()), to_mm(lower.z()), to_mm(upper.z()));
}

}  // namespace

std::string workspace_json(const WorkspaceStudy& study) {
  const Workspace& w = study.workspace;
  Json json;
  json["schema"] = "understudy.workspace/1";
  json["machine"] = study.machine.name;
  json["grid"] = grid_value(w);
  json["tilt_deg"] = stable_number(to_deg(study.tilt), "tilt");
  json["azimuth_deg"] = Json::array();
  for (const double a : study.azimuths) json["azimuth_deg"].push_back(stable_number(to_deg(a), "azimuth"));
  json["reachable"]["points"] = w.reachable;
  json["reachable"]["fraction"] = stable_number(w.fraction(), "fraction");
  json["binding"] = limits_value(w, w.families);
  json["limits"] = limits_value(w, w.limits);
  if (const auto cube = largest_cube(w)) json["largest_cube"] = box_value(w, *cube);
  if (const auto box = largest_box(w)) json["largest_box"] = box_value(w, *box);
  if (w.reachable > 0) {
    json["margin"] = quantiles_value(reachable_quantiles(w, w.margin));
    json["condition"] = quantiles_value(reachable_quantiles(w, w.condition));
    json["axes"] = axes_value(study);
  }
  json["provenance"]["version"] = kVersion;
  json["provenance"]["machine_sha256"] = study.machine.sha256;
  json["provenance"]["command"] = study.command;
  return to_text(json, 2) + "\n";
}

std::string workspace_table(const WorkspaceStudy& study) {
  const Workspace& w = study.workspace;
  const auto& grid = w.grid;
  std::string text = fmt::format("{}, {}\n", study.machine.name, orientation_text(study));
  text += fmt::format("{:<14} x {:g}..{:g}, y {:g}..{:g}, z {:g}..{:g} mm, a point every {:.4g} mm\n", "grid",
                      to_mm(grid.lower.x()), to_mm(grid.upper.x()), to_mm(grid.lower.y()),
                      to_mm(grid.upper.y()), to_mm(grid.lower.z()), to_mm(grid.upper.z()), to_mm(grid.step));
  text += fmt::format("{:<14} {:.1f} % ({} of {} points)\n", "reachable", 100 * w.fraction(), w.reachable,
                      w.binding.size());
  text += box_line("largest cube", w, largest_cube(w));
  text += box_line("largest box", w, largest_box(w));
  if (const auto condition = reachable_quantiles(w, w.condition); !condition.empty())
    text += fmt::format("{:<14} {:.3g} to {:.3g}, median {:.3g}\n", "condition", condition.front(),
                        condition.back(), condition[2]);
  if (w.families.empty()) return text;
  text += fmt::format("\n{:<38} {:>12} {:>12} {:>14}\n", "limit", "binds first", "broken", "opens alone");
  text += fmt::format("{:<38} {:>12} {:>12} {:>14}\n", "", "% of failing", "% of failing", "% of the grid");
  for (const WorkspaceLimit& family : w.families)
    text += fmt::format("{:<38} {:>12.1f} {:>12.1f} {:>14.1f}\n", studies::limit_text(family),
                        100 * share(family.binds, failing(w)), 100 * share(family.broken, failing(w)),
                        100 * share(family.alone, static_cast<std::int64_t>(w.binding.size())));
  return text;
}

}  // namespace understudy::report
