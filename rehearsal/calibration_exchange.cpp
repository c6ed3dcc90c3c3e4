#include "rehearsal/calibration_exchange.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using Json = nlohmann::ordered_json;
using calibration::HexapodParameters;
using calibration::kStruts;

constexpr double kNonsense = 10;  // [m]: no joint of a machine is so far out

Json point_mm(const Vec3& p) { return Json::array({to_mm(p.x()), to_mm(p.y()), to_mm(p.z())}); }

Json points_mm(const std::array<Vec3, kStruts>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(point_mm(p));
  return list;
}

Json lengths_mm(const calibration::StrutLengths& lengths) {
  Json list = Json::array();
  for (const double l : lengths) list.push_back(to_mm(l));
  return list;
}

Json sample_value(const HexapodParameters& nominal, const calibration::PoseSample& sample) {
  Json value;
  const Quat q(sample.X_BT.linear());
  value["position_mm"] = point_mm(sample.X_BT.translation());
  value["quaternion_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < 6; ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < 6; ++c)
      row.push_back(sample.covariance(r, c) * (r < 3 ? 1e3 : 1) * (c < 3 ? 1e3 : 1));
    rows.push_back(row);
  }
  value["covariance_mm_rad"] = rows;
  value["displacements_mm"] = lengths_mm(sample.displacement);
  calibration::StrutLengths commanded;
  for (std::size_t i = 0; i < kStruts; ++i)
    commanded[i] = sample.displacement[i] + nominal.geometry.length_offset[i];
  value["commanded_lengths_mm"] = lengths_mm(commanded);
  value["approach"] = Json::array();
  for (const auto a : sample.approach) value["approach"].push_back(static_cast<int>(a));
  return value;
}

/// What is wrong with an answer.
struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

double number(const Json& value, const std::string& where) {
  if (!value.is_number()) throw Wrong(fmt::format("{} is {}, not a number", where, value.type_name()));
  const double metres = from_mm(value.get<double>());
  if (!std::isfinite(metres) || std::abs(metres) > kNonsense)
    throw Wrong(fmt::format("{} is {} mm, beyond {:g} mm", where, value.get<double>(), to_mm(kNonsense)));
  return metres;
}

const Json& list(const Json& parent, const std::string& key, std::size_t count) {
  if (!parent.contains(key)) throw Wrong(fmt::format("has no {}", key));
  const Json& value = parent.at(key);
  if (!value.is_array() || value.size() != count)
    throw Wrong(fmt::format("{} is not a list of {}", key, count));
  return value;
}

void read_points(const Json& answer, const std::string& key, std::array<Vec3, kStruts>& points) {
  const Json& rows = list(answer, key, kStruts);
  for (std::size_t i = 0; i < kStruts; ++i) {
    if (!rows[i].is_array() || rows[i].size() != 3)
      throw Wrong(fmt::format("{}[{}] is not a list of 3", key, i));
    for (std::size_t k = 0; k < 3; ++k)
      points[i][static_cast<Eigen::Index>(k)] = number(rows[i][k], fmt::format("{}[{}][{}]", key, i, k));
  }
}

void read_parameters(const Json& answer, HexapodParameters& parameters) {
  if (!answer.is_object()) throw Wrong("is not an object");
  const Json schema = answer.contains("schema") ? answer.at("schema") : Json();
  if (schema != "understudy.calibration-answer/1")
    throw Wrong(
        fmt::format("its schema is {}, not \"understudy.calibration-answer/1\"", brief(schema.dump(), 60)));
  if (answer.contains("failure")) {
    const Json& why = answer.at("failure");
    throw Wrong("says: " + brief(why.is_string() ? why.get<std::string>() : why.dump()));
  }
  read_points(answer, "base_joints_mm", parameters.geometry.base_joint);
  read_points(answer, "platform_joints_mm", parameters.geometry.platform_joint);
  const Json& offsets = list(answer, "length_offsets_mm", kStruts);
  for (std::size_t i = 0; i < kStruts; ++i)
    parameters.geometry.length_offset[i] = number(offsets[i], fmt::format("length_offsets_mm[{}]", i));
  if (answer.contains("deviation_mm"))
    parameters.geometry.deviation = number(answer.at("deviation_mm"), "deviation_mm");
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
  PluginAnswer answer;
  answer.parameters = nominal;
  try {
    read_parameters(Json::parse(text), answer.parameters);
    answer.ok = true;
  } catch (const Wrong& wrong) {
    answer.failure = std::string("answer ") + wrong.what();
  } catch (const Json::exception&) {
    answer.failure = fmt::format("standard output is not one JSON value: \"{}\"", brief(text, 60));
  }
  if (!answer.ok) answer.parameters = nominal;
  return answer;
}

PluginAnswer ask_plugin(const std::string& command, const calibration::Problem& problem,
                        const PluginLimits& limits, double& seconds) {
  const PluginRun run = run_plugin(command, problem_json(problem), limits);
  seconds = run.seconds;
  PluginAnswer answer;
  answer.parameters = problem.nominal;
  if (!run.ok) {
    answer.failure = run.failure;
    return answer;
  }
  if (run.output.find_first_not_of(" \t\r\n") != std::string::npos)
    return read_answer(run.output, problem.nominal);
  answer.failure = "wrote nothing to standard output";
  if (!brief(run.error_output).empty())
    answer.failure += fmt::format("; standard error: \"{}\"", brief(run.error_output));
  return answer;
}

}  // namespace understudy::rehearsal
