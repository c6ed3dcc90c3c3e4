#include "kinematics/mechanism.h"

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::kinematics {
namespace {

struct ReportUnit {
  double factor;
  const char* name;
};

ReportUnit report_unit(const std::string& unit) {
  if (unit == "m") return {1e3, " mm"};
  if (unit == "m/s") return {1e3, " mm/s"};
  if (unit == "m/s^2") return {1e3, " mm/s^2"};
  if (unit == "rad") return {1 / kDegree, " deg"};
  if (unit == "rad/s") return {1 / kDegree, " deg/s"};
  if (unit == "rad/s^2") return {1 / kDegree, " deg/s^2"};
  return {1, ""};
}

std::string decimal(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

struct Figures {
  std::string value, limit;
};

// As few digits as still tell the two apart: "240.0 mm, longer than 240.0 mm" would help nobody.
Figures figures(const LimitViolation& v) {
  const ReportUnit unit = report_unit(v.unit);
  int digits = 1;
  while (digits < 9 && decimal(unit.factor * v.value, digits) == decimal(unit.factor * v.limit, digits))
    ++digits;
  return {decimal(unit.factor * v.value, digits) + unit.name,
          decimal(unit.factor * v.limit, digits) + unit.name};
}

}  // namespace

const char* to_string(SolveStatus s) {
  switch (s) {
    case SolveStatus::ok:
      return "ok";
    case SolveStatus::unreachable:
      return "unreachable";
    case SolveStatus::singular:
      return "singular";
    case SolveStatus::not_converged:
      return "not converged";
    case SolveStatus::bad_input:
      return "bad input";
  }
  return "unknown";
}

const char* to_string(LimitKind kind) {
  switch (kind) {
    case LimitKind::strut_length:
      return "strut_length";
    case LimitKind::joint_angle:
      return "joint_angle";
    case LimitKind::joint_limit:
      return "joint_limit";
    case LimitKind::screw_distance:
      return "screw_distance";
    case LimitKind::axis_velocity:
      return "axis_velocity";
    case LimitKind::axis_acceleration:
      return "axis_acceleration";
    case LimitKind::singularity:
      return "singularity";
    case LimitKind::unreachable:
      return "unreachable";
  }
  return "unknown";
}

std::string to_string(const LimitViolation& violation) {
  if (violation.unit.empty()) return violation.part + " cannot be reached";
  const auto [value, limit] = figures(violation);
  const bool above = violation.value > violation.limit;
  const std::string is_at = violation.part + " is at " + value + ", " + (above ? "above " : "below ") + limit;
  switch (violation.kind) {
    case LimitKind::strut_length:
      return violation.part + " is " + value + (above ? ", longer than " : ", shorter than ") + limit;
    case LimitKind::screw_distance:
      return violation.part + " are " + value + " apart, nearer than " + limit;
    case LimitKind::axis_velocity:
      return violation.part + " moves at " + value + ", faster than " + limit;
    case LimitKind::axis_acceleration:
      return violation.part + " accelerates at " + value + ", more than " + limit;
    case LimitKind::singularity:
      if (violation.unit != "1")
        return violation.part + " is " + value + " from a singular position, nearer than " + limit;
      return violation.part + " has condition number " + value + ", above " + limit;
    case LimitKind::unreachable:
      return violation.part + " spans " + value + (above ? ", more than " : ", less than ") + limit;
    case LimitKind::joint_angle:
    case LimitKind::joint_limit:
      return is_at;
  }
  return is_at;
}

SolveStatus Mechanism::pose_at_turns(const RotaryTarget& /*at*/, Pose& /*X_BT*/) const {
  return SolveStatus::bad_input;
}

SolveStatus Mechanism::parts_at_turns(const RotaryTarget& /*at*/, Mat3& /*table*/, Mat3& /*head*/) const {
  return SolveStatus::bad_input;
}

SolveStatus Mechanism::pose_at_slides(const RotaryTarget& /*at*/, Pose& /*X_BT*/) const {
  return SolveStatus::bad_input;
}

SolveStatus Mechanism::slides_at_turns(const RotaryTarget& /*at*/, Vec3& /*slides*/) const {
  return SolveStatus::bad_input;
}

SolveStatus Mechanism::axes_at_turns(const RotaryTarget& /*at*/, const RotaryTarget& /*rate*/,
                                     std::span<double> /*axes*/, std::span<double> /*axis_rates*/) const {
  return SolveStatus::bad_input;
}

}  // namespace understudy::kinematics
