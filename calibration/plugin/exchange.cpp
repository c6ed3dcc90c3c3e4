#include "calibration/plugin/exchange.h"

#include <fmt/format.h>

#include "calibration/plugin/exchange_json.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using calibration::HexapodParameters;
using calibration::kStruts;
using exchange::Json;

Json points_mm(const kinematics::PerStrut<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(exchange::point_mm(p));
  return list;
}

Json lengths_mm(const calibration::StrutLengths& lengths) {
  Json list = Json::array();
  for (const double l : lengths) list.push_back(to_mm(l));
  return list;
}

Json sample_value(const HexapodParameters& nominal, const calibration::PoseSample& sample) {
  Json value;
  value["position_mm"] = exchange::point_mm(sample.X_BT.translation());
  value["quaternion_wxyz"] = exchange::quaternion_wxyz(sample.X_BT.linear());
  value["covariance_mm_rad"] = exchange::covariance_mm_rad(sample.covariance);
  value["displacements_mm"] = lengths_mm(sample.displacement);
  calibration::StrutLengths commanded;
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
  exchange::check_schema(answer, "understudy.calibration-answer/1");
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

std::string problem_json(const calibration::Problem& problem) {
  const auto& g = problem.nominal.geometry;
  Json value;
  value["schema"] = "understudy.calibration-problem/1";
  value["nominal"]["base_joints_mm"] = points_mm(g.base_joint);
  value["nominal"]["platform_joints_mm"] = points_mm(g.platform_joint);
  value["nominal"]["length_offsets_mm"] = lengths_mm(g.length_offset);
  value["nominal"]["deviation_mm"] = to_mm(g.deviation);
  value["samples"] = Json::array();
  for (const auto& sample : problem.samples)
    value["samples"].push_back(sample_value(problem.nominal, sample));
  return value.dump() + "\n";
}

PluginAnswer read_answer(const std::string& text, const HexapodParameters& nominal) {
  return exchange::read_answer<PluginAnswer>(text, nominal, read_parameters);
}

PluginAnswer ask_plugin(const std::string& command, const calibration::Problem& problem,
                        const PluginLimits& limits, double& seconds) {
  std::string output;
  const std::string failure = exchange::ask(command, problem_json(problem), limits, seconds, output);
  if (failure.empty()) return read_answer(output, problem.nominal);
  return {false, failure, problem.nominal};
}

}  // namespace understudy::rehearsal
