#include "report/pose_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using kinematics::AxisVector;
using kinematics::Mechanism;

double file_unit(const Mechanism& mechanism, int axis) {
  return mechanism.axis_is_angle(axis) ? kDegree : kMillimetre;
}

Json vector_value(const Vec3& v, double unit) {
  Json value = Json::array();
  for (const double x : v) value.push_back(stable_number(std::round(1e9 * x / unit) / 1e9, "pose", 9));
  return value;
}

Json axes_value(const Mechanism& mechanism, const AxisVector& axes) {
  Json list = Json::array();
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    const double unit = file_unit(mechanism, i);
    Json value;
    value["axis"] = mechanism.axis_name(i);
    value["unit"] = mechanism.axis_is_angle(i) ? "deg" : "mm";
    value["position"] = stable_number(axes[static_cast<std::size_t>(i)] / unit, "position", 9);
    const auto range = mechanism.axis_range(i);
    if (std::isfinite(range.lower) && std::isfinite(range.upper))
      value["range"] = {stable_number(range.lower / unit, "range"),
                        stable_number(range.upper / unit, "range")};
    list.push_back(value);
  }
  return list;
}

Json branches_value(const Mechanism& mechanism, const std::vector<AxisVector>& others) {
  Json list = Json::array();
  for (const AxisVector& axes : others) {
    Json row = Json::array();
    for (int i = 0; i < mechanism.axis_count(); ++i)
      row.push_back(
          stable_number(axes[static_cast<std::size_t>(i)] / file_unit(mechanism, i), "position", 9));
    list.push_back(row);
  }
  return list;
}

Json clearance_value(const rehearsal::NearestPair& pair) {
  return {{"distance_mm", stable_number(to_mm(pair.distance), "distance_mm")},
          {"body", pair.body},
          {"obstacle", pair.obstacle}};
}

}  // namespace

std::string pose_json(const rehearsal::PoseLook& look, const Mechanism& mechanism, const std::string& machine,
                      const std::string& command) {
  Json value;
  value["machine"] = machine;
  value["good"] = look.good();
  value["status"] = kinematics::to_string(look.status);
  value["broken"] = Json::array();
  for (const auto& violation : look.broken) value["broken"].push_back(to_string(violation));
  value["tip_mm"] = vector_value(look.X_WT.translation(), kMillimetre);
  value["tool_axis"] = vector_value(tool_axis(look.X_WT), 1);
  if (look.status == kinematics::SolveStatus::ok) {
    value["axes"] = axes_value(mechanism, look.axes);
    value["branches"] = branches_value(mechanism, look.others);
    value["singular"] = look.condition >= kinematics::kSingularCondition;
    if (std::isfinite(look.condition))
      value["condition_number"] = stable_number(look.condition, "condition_number");
  }
  if (look.nozzle) value["nozzle"] = clearance_value(*look.nozzle);
  if (look.nearest) value["clearance"] = clearance_value(*look.nearest);
  value["version"] = kVersion;
  value["command"] = command;
  return to_text(value, 2);
}

}  // namespace understudy::report
