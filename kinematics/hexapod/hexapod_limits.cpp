#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinematics/hexapod/hexapod.h"

namespace understudy::kinematics {
namespace {

struct Strut {
  Vec3 base, ball;  // [m], in B
};

Strut strut_segment(const HexapodGeometry& geometry, const Pose& X_BT, int strut) {
  return {geometry.base_joint[strut], X_BT * geometry.platform_joint[strut]};
}

// Closest points of two segments p + s u and q + t v, s and t in [0, 1]: minimise over s with t free, clamp
// t, then give s its best value for that t.
double segment_distance(const Strut& first, const Strut& second) {
  const Vec3 u = first.ball - first.base, v = second.ball - second.base, w = first.base - second.base;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double denominator = uu * vv - uv * uv;
  double s = denominator > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / denominator, 0.0, 1.0) : 0.0;
  const double t = vv > 0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  return (w + s * u - t * v).norm();
}

std::string numbered(const char* what, int index) {
  return std::string(what) + " " + std::to_string(index + 1);
}

struct Range {
  double low, high;
};

/// Its name, "base joint 2 (lateral)", is only built for what is outside: check_range runs at every point of
/// every path.
struct Part {
  const char* what;
  int index;  // from 0
  const char* suffix = "";
};

void check_range(LimitKind kind, const Part& part, double value, Range range, const char* unit,
                 std::vector<LimitViolation>& violations) {
  if (value >= range.low && value <= range.high) return;
  violations.push_back({kind, numbered(part.what, part.index) + part.suffix, value,
                        value > range.high ? range.high : range.low, unit});
}

void check_joints(const HexapodLimits& limits, const StrutAngles& angles, int strut,
                  std::vector<LimitViolation>& violations) {
  check_range(LimitKind::joint_angle, {"base joint", strut}, angles.alpha,
              {limits.base_alpha_min, limits.base_alpha_max}, "rad", violations);
  check_range(LimitKind::joint_angle, {"base joint", strut, " (lateral)"}, angles.beta,
              {-limits.base_beta_max, limits.base_beta_max}, "rad", violations);
  check_range(LimitKind::joint_angle, {"ball joint", strut}, angles.ball, {limits.ball_min, limits.ball_max},
              "rad", violations);
}

void report_out_of_reach(const HexapodGeometry& geometry, const Pose& X_BT,
                         std::vector<LimitViolation>& violations) {
  if (!X_BT.matrix().allFinite()) {
    violations.push_back({LimitKind::unreachable, "a pose that is not finite", 0, 0, ""});
    return;
  }
  for (int i = 0; i < kStruts; ++i) {
    const Strut strut = strut_segment(geometry, X_BT, i);
    const double span = (strut.ball - strut.base).norm();
    if (span <= geometry.deviation)
      violations.push_back({LimitKind::unreachable, numbered("strut", i), span, geometry.deviation, "m"});
  }
}

}  // namespace

double condition_number(const HexapodGeometry& geometry, const Pose& X_BT) {
  Mat6 J;
  if (jacobian(geometry, X_BT, J) != SolveStatus::ok) return kSingularCondition;
  J.rightCols<3>() /= platform_radius(geometry);
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(J.transpose() * J, Eigen::EigenvaluesOnly);
  const double low = solver.eigenvalues().minCoeff(), high = solver.eigenvalues().maxCoeff();
  // Squared singular values: below this ratio only rounding is left.
  if (!(low * kSingularCondition * kSingularCondition > high)) return kSingularCondition;
  return std::sqrt(high / low);
}

double screw_distance(const HexapodGeometry& geometry, const Pose& X_BT, int strut, int other) {
  return segment_distance(strut_segment(geometry, X_BT, strut), strut_segment(geometry, X_BT, other));
}

StrutAngles strut_angles(const HexapodGeometry& geometry, const HexapodJoints& joints, const Pose& X_BT,
                         int strut) {
  const Strut segment = strut_segment(geometry, X_BT, strut);
  const Vec3 u = (segment.ball - segment.base).normalized();
  const Vec3 e_r = joints.radial_axis[strut], e_z = Vec3::UnitZ(), e_t = e_z.cross(e_r);
  const double stud = -u.dot(X_BT.linear() * joints.stud_axis[strut]);
  return {std::atan2(-u.dot(e_r), -u.z()), std::asin(std::clamp(u.dot(e_t), -1.0, 1.0)),
          std::acos(std::clamp(stud, -1.0, 1.0))};
}

void check(const HexapodGeometry& geometry, const HexapodJoints& joints, const HexapodLimits& limits,
           const Pose& X_BT, std::vector<LimitViolation>& violations) {
  StrutLengths lengths;
  if (inverse(geometry, X_BT, lengths) != SolveStatus::ok) {
    report_out_of_reach(geometry, X_BT, violations);
    return;
  }
  int strut = 0;
  for (const double length : lengths)
    check_range(LimitKind::strut_length, {"strut", strut++}, length, {limits.strut_min, limits.strut_max},
                "m", violations);
  for (int i = 0; i < kStruts; ++i)
    check_joints(limits, strut_angles(geometry, joints, X_BT, i), i, violations);
  for (int i = 0; i < kStruts; ++i) {
    for (int j = i + 1; j < kStruts; ++j) {
      const double distance = screw_distance(geometry, X_BT, i, j);
      if (distance < limits.screw_distance_min)
        violations.push_back({LimitKind::screw_distance,
                              numbered("struts", i) + " and " + std::to_string(j + 1), distance,
                              limits.screw_distance_min, "m"});
    }
  }
  const double condition = condition_number(geometry, X_BT);
  if (condition > limits.condition_max)
    violations.push_back({LimitKind::singularity, "platform", condition, limits.condition_max, "1"});
}

}  // namespace understudy::kinematics
