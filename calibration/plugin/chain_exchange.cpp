#include "calibration/plugin/exchange.h"

#include <cmath>

#include <fmt/format.h>

#include "calibration/plugin/exchange_json.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using exchange::Json;
using exchange::Wrong;

constexpr double kUnit = 1e-6;  // of a direction's or a quaternion's length: six digits may be printed
constexpr double kTurns = 10;   // [rad]: no zero of an axis is farther off

double in_mm_rad(double value, bool angle) { return angle ? value : to_mm(value); }

Json pose_value(const Pose& X) {
  Json value;
  value["position_mm"] = exchange::point_mm(X.translation());
  value["quaternion_wxyz"] = exchange::quaternion_wxyz(X.linear());
  return value;
}

Json axis_value(const kinematics::ChainAxis& axis, double zero) {
  Json value;
  value["name"] = axis.name;
  value["moves"] = axis.angle ? "turns" : "slides";
  value["direction"] = Json::array({axis.direction.x(), axis.direction.y(), axis.direction.z()});
  value["point_mm"] = exchange::point_mm(axis.point);
  value["zero_mm_rad"] = in_mm_rad(zero, axis.angle);
  value["parent"] = axis.parent;
  return value;
}

double zero_of(const ChainParameters& machine, std::size_t i) {
  return machine.zero.empty() ? 0 : machine.zero[i];
}

Json sample_value(const kinematics::Chain& chain, const ChainSample& sample) {
  Json value = pose_value(sample.X_ST);
  value["covariance_mm_rad"] = exchange::covariance_mm_rad(sample.covariance);
  value["readings_mm_rad"] = Json::array();
  for (std::size_t i = 0; i < sample.axes.size(); ++i)
    value["readings_mm_rad"].push_back(in_mm_rad(sample.axes[i], chain.axes[i].angle));
  return value;
}

Vec3 direction(const Json& axis, const std::string& where) {
  const Json& told = exchange::list(axis, "direction", 3);
  Vec3 d;
  for (std::size_t k = 0; k < 3; ++k)
    d[static_cast<Eigen::Index>(k)] =
        exchange::number(told[k], fmt::format("{}.direction[{}]", where, k), 2, "");
  if (std::abs(d.norm() - 1) > kUnit)
    throw Wrong(fmt::format("{}.direction has length {:.9g}, must be 1", where, d.norm()));
  return d.normalized();
}

void read_axis(const Json& told, const std::string& where, kinematics::ChainAxis& axis, double& zero) {
  if (!told.is_object()) throw Wrong(where + " is not an object");
  axis.direction = direction(told, where);
  if (axis.angle) {
    if (!told.contains("point_mm")) throw Wrong(fmt::format("{} has no point_mm", where));
    axis.point = exchange::point(told.at("point_mm"), where + ".point_mm");
  }
  if (!told.contains("zero_mm_rad")) return;
  const std::string name = where + ".zero_mm_rad";
  zero = axis.angle ? exchange::number(told.at("zero_mm_rad"), name, kTurns, " rad")
                    : exchange::length_mm(told.at("zero_mm_rad"), name);
}

void read_pose(const Json& answer, const std::string& key, Pose& X) {
  if (!answer.contains(key)) return;
  const Json& told = answer.at(key);
  if (!told.is_object() || !told.contains("position_mm")) throw Wrong(key + " has no position_mm");
  const Vec3 p = exchange::point(told.at("position_mm"), key + ".position_mm");
  const Json& q = exchange::list(told, "quaternion_wxyz", 4);
  std::array<double, 4> c{};
  for (std::size_t k = 0; k < 4; ++k)
    c[k] = exchange::number(q[k], fmt::format("{}.quaternion_wxyz[{}]", key, k), 2, "");
  const Quat turn(c[0], c[1], c[2], c[3]);
  if (std::abs(turn.norm() - 1) > kUnit)
    throw Wrong(fmt::format("{}.quaternion_wxyz has length {:.9g}, must be 1", key, turn.norm()));
  X = make_pose(turn.normalized(), p);
}

void read_parameters(const Json& answer, ChainParameters& machine) {
  const Json& axes = exchange::list(answer, "axes", machine.chain.axes.size());
  machine.zero.resize(axes.size(), 0.0);
  for (std::size_t i = 0; i < axes.size(); ++i)
    read_axis(axes[i], fmt::format("axes[{}]", i), machine.chain.axes[i], machine.zero[i]);
  read_pose(answer, "tool", machine.chain.X_OT_zero);
  read_pose(answer, "work", machine.chain.X_OS_zero);
}

}  // namespace

std::string problem_json(const ChainProblem& problem) {
  const ChainParameters& nominal = problem.nominal;
  Json value = exchange::problem_value("chain");
  Json& machine = value["nominal"];
  machine["axes"] = Json::array();
  for (std::size_t i = 0; i < nominal.chain.axes.size(); ++i)
    machine["axes"].push_back(axis_value(nominal.chain.axes[i], zero_of(nominal, i)));
  machine["tool_axis"] = nominal.chain.tool_axis;
  machine["work_axis"] = nominal.chain.work_axis;
  machine["tool"] = pose_value(nominal.chain.X_OT_zero);
  machine["work"] = pose_value(nominal.chain.X_OS_zero);
  value["samples"] = Json::array();
  for (const ChainSample& sample : problem.samples)
    value["samples"].push_back(sample_value(nominal.chain, sample));
  return value.dump() + "\n";
}

std::string read_answer(const std::string& text, ChainParameters& parameters) {
  return exchange::read_parameters(text, parameters, read_parameters);
}

}  // namespace understudy::calibration
