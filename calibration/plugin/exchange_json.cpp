#include "calibration/plugin/exchange_json.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal::exchange {
namespace {

constexpr double kNonsense = 10e3;  // [mm]: no joint of a machine is so far out

}  // namespace

Json point_mm(const Vec3& p) { return Json::array({to_mm(p.x()), to_mm(p.y()), to_mm(p.z())}); }

Json quaternion_wxyz(const Mat3& R) {
  const Quat q(R);
  return Json::array({q.w(), q.x(), q.y(), q.z()});
}

Json covariance_mm_rad(const Mat6& covariance) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < 6; ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < 6; ++c)
      row.push_back(covariance(r, c) * (r < 3 ? 1e3 : 1) * (c < 3 ? 1e3 : 1));
    rows.push_back(row);
  }
  return rows;
}

double number(const Json& value, const std::string& where, double limit, const char* unit) {
  if (!value.is_number()) throw Wrong(fmt::format("{} is {}, not a number", where, value.type_name()));
  const double told = value.get<double>();
  if (!std::isfinite(told) || std::abs(told) > limit)
    throw Wrong(fmt::format("{} is {}{}, beyond {:g}{}", where, told, unit, limit, unit));
  return told;
}

double length_mm(const Json& value, const std::string& where) {
  return from_mm(number(value, where, kNonsense, " mm"));
}

const Json& list(const Json& parent, const std::string& key, std::size_t count) {
  if (!parent.contains(key)) throw Wrong(fmt::format("has no {}", key));
  const Json& value = parent.at(key);
  if (!value.is_array() || value.size() != count)
    throw Wrong(fmt::format("{} is not a list of {}", key, count));
  return value;
}

Vec3 point(const Json& value, const std::string& where) {
  if (!value.is_array() || value.size() != 3) throw Wrong(fmt::format("{} is not a list of 3", where));
  Vec3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[static_cast<Eigen::Index>(k)] = length_mm(value[k], fmt::format("{}[{}]", where, k));
  return p;
}

void check_schema(const Json& answer, const std::string& schema) {
  if (!answer.is_object()) throw Wrong("is not an object");
  const Json told = answer.contains("schema") ? answer.at("schema") : Json();
  if (told != schema)
    throw Wrong(fmt::format("its schema is {}, not \"{}\"", brief(told.dump(), 60), schema));
  if (!answer.contains("failure")) return;
  const Json& why = answer.at("failure");
  throw Wrong("says: " + brief(why.is_string() ? why.get<std::string>() : why.dump()));
}

std::string read_json(const std::string& text, const std::function<void(const Json&)>& read) {
  try {
    read(Json::parse(text));
    return {};
  } catch (const Wrong& wrong) {
    return std::string("answer ") + wrong.what();
  } catch (const Json::exception&) {
    return fmt::format("standard output is not one JSON value: \"{}\"", brief(text, 60));
  }
}

std::string ask(const std::string& command, const std::string& problem, const PluginLimits& limits,
                double& seconds, std::string& output) {
  const PluginRun run = run_plugin(command, problem, limits);
  seconds = run.seconds;
  output = run.output;
  if (!run.ok) return run.failure;
  if (run.output.find_first_not_of(" \t\r\n") != std::string::npos) return {};
  std::string failure = "wrote nothing to standard output";
  if (!brief(run.error_output).empty())
    failure += fmt::format("; standard error: \"{}\"", brief(run.error_output));
  return failure;
}

}  // namespace understudy::rehearsal::exchange
