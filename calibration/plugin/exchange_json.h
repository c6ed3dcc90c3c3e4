// Private to the exchange with plug-ins: what both of its schemas are written and read with.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "calibration/plugin/plugin.h"
#include "core/frames.h"

namespace understudy::rehearsal::exchange {

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
/// Of an object with that schema and without "failure".
void check_schema(const Json& answer, const std::string& schema);

/// Reads `text` by `read`; the failure in one line, or empty.
std::string read_json(const std::string& text, const std::function<void(const Json&)>& read);

/// An answer (ok, failure, parameters) whose parameters are the nominal ones where it fails.
template <typename Answer, typename Parameters, typename Read>
Answer read_answer(const std::string& text, const Parameters& nominal, const Read& read) {
  Answer answer{false, {}, nominal};
  answer.failure = read_json(text, [&](const Json& json) { read(json, answer.parameters); });
  answer.ok = answer.failure.empty();
  if (!answer.ok) answer.parameters = nominal;
  return answer;
}

/// Runs the plug-in: its output, or a failure in one line.
std::string ask(const std::string& command, const std::string& problem, const PluginLimits& limits,
                double& seconds, std::string& output);

}  // namespace understudy::rehearsal::exchange
