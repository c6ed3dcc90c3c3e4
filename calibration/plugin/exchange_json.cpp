#include "calibration/plugin/exchange_json.h"

#include <cmath>

#include <fmt/format.h>

#include "calibration/plugin/process_limits.h"
#include "core/text/json_depth.h"
#include "core/units.h"

namespace understudy::calibration::exchange {
namespace {

constexpr double kNonsense = 10e3;  // [mm]: no joint of a machine is so far out
constexpr const char* kAnswer = "understudy.calibration-answer/2";

/// An object with that schema and without "failure".
void check_schema(const Json& answer) {
  if (!answer.is_object()) throw Wrong("is not an object");
  const Json told = answer.contains("schema") ? answer.at("schema") : Json();
  if (told != kAnswer)
    throw Wrong(fmt::format("its schema is {}, not \"{}\"", brief(told.dump(), 60), kAnswer));
  if (!answer.contains("failure")) return;
  const Json& why = answer.at("failure");
  throw Wrong("says: " + brief(why.is_string() ? why.get<std::string>() : why.dump()));
}

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

Json problem_value(const std::string& machine) {
  Json value;
  value["schema"] = "understudy.calibration-problem/2";
  value["machine"] = machine;
  return value;
}

std::string read_json(const std::string& text, const std::function<void(const Json&)>& read) {
  if (nests_deeper(text))
    return fmt::format("answer nests lists or objects more than {} deep", kJsonDepthMax);
  try {
    const Json answer = Json::parse(text);
    check_schema(answer);
    read(answer);
    return {};
  } catch (const Wrong& wrong) {
    return std::string("answer ") + wrong.what();
  } catch (const Json::exception&) {
    return fmt::format("standard output is not one JSON value: \"{}\"", brief(text, 60));
  }
}

}  // namespace understudy::calibration::exchange
