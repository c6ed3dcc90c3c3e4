#include "kinematics/chain/arm.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

/// x of F up, z forwards, at all axes 0.
Mat3 flange_at_zero() {
  Mat3 R_BF;
  R_BF << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  return R_BF;
}

ChainAxis turning(int number, const Vec3& direction, const Vec3& point) {
  ChainAxis axis;
  axis.name = "j" + std::to_string(number);
  axis.direction = direction;
  axis.point = point;
  axis.parent = number - 2;
  return axis;
}

class Arm final : public ChainMechanism {
 public:
  // The tool's mount comes from the chain: a measured one may have replaced that of the parameters.
  explicit Arm(const ChainDescription& description)
      : ChainMechanism(description, true), geometry_(arm_geometry(description.parameters)) {
    const ArmGeometry& g = geometry_;
    const Pose X_OF_zero = make_pose(flange_at_zero(), Vec3(g.a1 + g.d4 + g.d6, 0, g.d1 + g.a2 + g.a3));
    geometry_.X_FT = X_OF_zero.inverse() * description.chain.X_OT_zero;
  }

  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override;
  void check(const Pose& X_ST, std::span<const double> axes,
             std::vector<LimitViolation>& violations) const override;

 private:
  ArmGeometry geometry_;
};

SolveStatus Arm::inverse(const Pose& X_ST, std::span<const double> previous, std::span<double> axes) const {
  if (axes.size() < kArmAxes || !is_pose(X_ST) || !usable(previous)) return SolveStatus::bad_input;
  const std::span<const double> beside = near(previous);
  ArmSolutions solutions;
  solutions.count = arm_branches(geometry_, chain().X_OS_zero * X_ST, solutions.all, beside);
  if (solutions.count == 0) return SolveStatus::unreachable;
  const ArmAxes* best = nullptr;
  bool best_within = false;
  double best_distance = 0;
  for (ArmSolution& s : std::span(solutions.all).first(static_cast<std::size_t>(solutions.count))) {
    const bool within = settle(previous, s.axes);
    const double distance = distance2(beside, s.axes);
    if (best != nullptr && (within != best_within ? best_within : distance >= best_distance)) continue;
    best = &s.axes;
    best_within = within;
    best_distance = distance;
  }
  std::copy(best->begin(), best->end(), axes.begin());
  return SolveStatus::ok;
}

void Arm::check(const Pose& X_ST, std::span<const double> axes,
                std::vector<LimitViolation>& violations) const {
  ChainMechanism::check(X_ST, axes, violations);
  if (axes.size() < kArmAxes) return;
  const ArmClearance at = arm_clearance(geometry_, axes);
  const auto expect = [&](const char* part, double value, double limit, const char* unit) {
    if (!(value >= limit)) violations.push_back({LimitKind::singularity, part, value, limit, unit});
  };
  expect("wrist", at.wrist, kArmClearanceMin.wrist, "rad");
  expect("elbow", at.elbow, kArmClearanceMin.elbow, "m");
  expect("shoulder", at.shoulder, kArmClearanceMin.shoulder, "m");
}

}  // namespace

ArmGeometry arm_geometry(std::span<const double> p) {
  const Mat3 R_tilt = Eigen::AngleAxisd(p[9], Vec3::UnitY()).toRotationMatrix();
  const Mat3 R_half_turn = Vec3(1, -1, -1).asDiagonal();
  return {p[0], p[1], p[2], p[3], p[4], p[5], make_pose(Mat3(R_tilt * R_half_turn), Vec3(p[6], p[7], p[8]))};
}

Chain arm_chain(const ArmGeometry& g) {
  const Vec3 shoulder(g.a1, 0, g.d1), elbow(g.a1, 0, g.d1 + g.a2), wrist(g.a1 + g.d4, 0, g.d1 + g.a2 + g.a3);
  Chain chain;
  chain.axes = {turning(1, Vec3::UnitZ(), Vec3::Zero()), turning(2, Vec3::UnitY(), shoulder),
                turning(3, Vec3::UnitY(), elbow),        turning(4, Vec3::UnitX(), wrist),
                turning(5, Vec3::UnitY(), wrist),        turning(6, Vec3::UnitX(), wrist)};
  chain.tool_axis = kArmAxes - 1;
  chain.X_OT_zero = make_pose(flange_at_zero(), wrist + Vec3(g.d6, 0, 0)) * g.X_FT;
  return chain;
}

ArmClearance arm_clearance(const ArmGeometry& g, std::span<const double> axes) {
  const double forearm = std::hypot(g.a3, g.d4);
  const double elbow = axes[2] + std::atan2(g.d4, g.a3);
  const double reach =
      std::sqrt(std::max(0.0, g.a2 * g.a2 + forearm * forearm + 2 * g.a2 * forearm * std::cos(elbow)));
  const double bend = std::remainder(axes[4], std::numbers::pi);
  return {std::abs(bend), std::min(g.a2 + forearm - reach, reach - std::abs(g.a2 - forearm)),
          std::abs(g.a1 + g.a2 * std::sin(axes[1]) + forearm * std::sin(axes[1] + elbow))};
}

ChainKind arm_kind() {
  // Beyond these an arm is no printer's, or a slip of the unit.
  ChainKind kind;
  kind.name = "arm";
  kind.may_be_calibrated = true;
  kind.parameters = {
      {"d1_mm", 0, 5000, "height of axis 2 above the base"},
      {"a1_mm", -2000, 2000, "axis 2 before axis 1"},
      {"a2_mm", 10, 5000, "upper arm, axis 2 to axis 3"},
      {"a3_mm", -2000, 2000, "wrist centre above axis 3"},
      {"d4_mm", 10, 5000, "wrist centre before axis 3"},
      {"d6_mm", 0, 2000, "wrist centre to the flange"},
      {"tool_x_mm", -2000, 2000, "tip on the flange; up at zero"},
      {"tool_y_mm", -2000, 2000, "tip on the flange"},
      {"tool_z_mm", -2000, 2000, "tip on the flange, along its axis"},
      {"tool_tilt_deg", -180, 180,
       "0: the nozzle points along the flange's axis; positive leans it towards the flange's x"}};
  kind.chain = [](std::span<const double> parameters) { return arm_chain(arm_geometry(parameters)); };
  kind.make = [](const ChainDescription& description) -> std::unique_ptr<Mechanism> {
    return std::make_unique<Arm>(description);
  };
  return kind;
}

}  // namespace understudy::kinematics
