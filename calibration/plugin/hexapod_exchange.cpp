#include "calibration/plugin/exchange.h"

#include <fmt/format.h>

#include "calibration/plugin/exchange_json.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using exchange::Json;

Json points_mm(const kinematics::PerStrut<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(exchange::point_mm(p));
  return list;
}

Json lengths_mm(const StrutLengths& lengths) {
  Json list = Json::array();
  for (const double l : lengths) list.push_back(to_mm(l));
  return list;
}

Json sample_value(const HexapodParameters& nominal, const PoseSample& sample) {
  Json value;
  value["position_mm"] = exchange::point_mm(sample.X_BT.translation());
  value["quaternion_wxyz"] = exchange::quaternion_wxyz(sample.X_BT.linear());
  value["covariance_mm_rad"] = exchange::covariance_mm_rad(sample.covariance);
  value["displacements_mm"] = lengths_mm(sample.displacement);
  StrutLengths commanded;
  for (std::size_t i = 0; i < kStruts; ++i)
    commanded[i] = sample.displacement[i] + nominal.geometry.length_offset[i];
  value["commanded_lengths_mm"] = lengths_mm(commanded);
  value["approach"] = Json::array();
  for (const auto a : sample.approach) value["approach"].push_back(static_cast<int>(a));
  return value;
}

void read_points(const Json& answer, const std::string& key, kinematics::PerStrut<Vec3>& points) {
  const Json& rows = exchange::list(answer, key, kStruts);
  for (std::size_t i = 0; i < kStruts; ++i)
    points[i] = exchange::point(rows[i], fmt::format("{}[{}]", key, i));
}

void read_parameters(const Json& answer, HexapodParameters& parameters) {
  read_points(answer, "base_joints_mm", parameters.geometry.base_joint);
  read_points(answer, "platform_joints_mm", parameters.geometry.platform_joint);
  const Json& offsets = exchange::list(answer, "length_offsets_mm", kStruts);
  for (std::size_t i = 0; i < kStruts; ++i)
    parameters.geometry.length_offset[i] =
        exchange::length_mm(offsets[i], fmt::format("length_offsets_mm[{}]", i));
  if (answer.contains("deviation_mm"))
    parameters.geometry.deviation = exchange::length_mm(answer.at("deviation_mm"), "deviation_mm");
}

}  // namespace

std::string problem_json(const Problem& problem) {
  const auto& g = problem.nominal.geometry;
  Json value = exchange::problem_value("hexapod");
  value["nominal"]["base_joints_mm"] = points_mm(g.base_joint);
  value["nominal"]["platform_joints_mm"] = points_mm(g.platform_joint);
  value["nominal"]["length_offsets_mm"] = lengths_mm(g.length_offset);
  value["nominal"]["deviation_mm"] = to_mm(g.deviation);
  value["samples"] = Json::array();
  for (const auto& sample : problem.samples)
    value["samples"].push_back(sample_value(problem.nominal, sample));
  return value.dump() + "\n";
}

std::string read_answer(const std::string& text, HexapodParameters& parameters) {
  return exchange::read_parameters(text, parameters, read_parameters);
}

}  // namespace understudy::calibration
