// Private to the exchange with plug-ins: what both kinds of machine are written and read with.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "core/frames.h"

namespace understudy::calibration::exchange {

using Json = nlohmann::ordered_json;

Json point_mm(const Vec3& p);
Json quaternion_wxyz(const Mat3& R);
/// Blocks in mm^2, mm rad and rad^2.
Json covariance_mm_rad(const Mat6& covariance);

/// What is wrong with an answer.
struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A number of at most `limit` on either side; `unit` (" mm") is for the reader. These throw Wrong.
double number(const Json& value, const std::string& where, double limit, const char* unit);
double length_mm(const Json& value, const std::string& where);  ///< [m]
const Json& list(const Json& parent, const std::string& key, std::size_t count);
Vec3 point(const Json& value, const std::string& where);  ///< [m]
/// A problem for this kind of machine ("hexapod", "chain"), with its schema and nothing else yet.
Json problem_value(const std::string& machine);

/// Checks the answer's schema and that it is no failure, then reads it by `read`. One line that says what is
/// wrong, or empty.
std::string read_json(const std::string& text, const std::function<void(const Json&)>& read);

/// The same into a copy of `parameters`, which takes its place only when all is read.
template <typename Parameters, typename Read>
std::string read_parameters(const std::string& text, Parameters& parameters, const Read& read) {
  Parameters told = parameters;
  const std::string wrong = read_json(text, [&](const Json& json) { read(json, told); });
  if (wrong.empty()) parameters = told;
  return wrong;
}

}  // namespace understudy::calibration::exchange
