#include "kinematics/hexapod/hexapod_passive_rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStretched =
    1e-9;                       // sine between a joint's fixed axis and the strut: no digit of the angle left
constexpr int kRoundsMax = 30;  // of the fixed point

/// About the strut, from the motor's inner axis to the joint axis that the screw carries.
SolveStatus joint_rotation(const HexapodGeometry& geometry, const HexapodJoints& joints, const Pose& X_BT,
                           int strut, double& angle) {
  angle = 0;
  const Vec3 d = X_BT * geometry.platform_joint[strut] - geometry.base_joint[strut];
  const double span = d.norm();
  if (!std::isfinite(span)) return SolveStatus::bad_input;
  if (!(span > 0)) return SolveStatus::singular;
  const Vec3 u = d / span;
  const Vec3 outer = Vec3::UnitZ().cross(joints.radial_axis[strut]).normalized();
  const Vec3 at_motor = outer.cross(u);
  const Vec3 at_screw = (X_BT.linear() * joints.stud_axis[strut]).cross(u);
  if (!(at_motor.norm() > kStretched && at_screw.norm() > kStretched)) return SolveStatus::singular;
  angle = std::atan2(u.dot(at_motor.cross(at_screw)), at_motor.dot(at_screw));
  return SolveStatus::ok;
}

SolveStatus lengthening(const HexapodGeometry& geometry, const ScrewCoupling& coupling, const Pose& X_BT,
                        StrutLengths& change) {
  for (int i = 0; i < kStruts; ++i) {
    double angle = 0;
    const SolveStatus status = passive_rotation(geometry, coupling, X_BT, i, angle);
    if (status != SolveStatus::ok) return status;
    change[i] = coupling.lead / kTurn * angle;
  }
  return SolveStatus::ok;
}

}  // namespace

ScrewCoupling screw_coupling(const HexapodGeometry& geometry, const HexapodJoints& joints,
                             const Pose& X_BT_home, double lead) {
  ScrewCoupling coupling{lead, joints, {}};
  for (int i = 0; i < kStruts; ++i) {
    double& angle = coupling.angle_at_home[i];
    // Joints without an angle at home have none anywhere: passive_rotation() says so at every pose.
    if (joint_rotation(geometry, joints, X_BT_home, i, angle) != SolveStatus::ok) angle = 0;
  }
  return coupling;
}

SolveStatus passive_rotation(const HexapodGeometry& geometry, const ScrewCoupling& coupling, const Pose& X_BT,
                             int strut, double& angle) {
  const SolveStatus status = joint_rotation(geometry, coupling.joints, X_BT, strut, angle);
  if (status != SolveStatus::ok) return status;
  angle = nearest_turn(angle - coupling.angle_at_home[strut], 0);
  return SolveStatus::ok;
}

SolveStatus inverse(const HexapodGeometry& geometry, const ScrewCoupling& coupling, const Pose& X_BT,
                    StrutLengths& drive_lengths) {
  StrutLengths lengths, change;
  SolveStatus status = inverse(geometry, X_BT, lengths);
  if (status == SolveStatus::ok && coupling.lead != 0) {
    status = lengthening(geometry, coupling, X_BT, change);
    for (std::size_t i = 0; i < kStruts && status == SolveStatus::ok; ++i) lengths[i] -= change[i];
  }
  if (status == SolveStatus::ok) drive_lengths = lengths;
  return status;
}

ForwardResult forward(const HexapodGeometry& geometry, const ScrewCoupling& coupling,
                      const StrutLengths& drive_lengths, const Pose& seed, const ForwardOptions& options) {
  if (coupling.lead == 0) return forward(geometry, drive_lengths, seed, options);
  ForwardResult result = forward(geometry, drive_lengths, seed, options);
  int iterations = result.iterations;
  StrutLengths change{}, lengths, drives_here;
  for (int round = 0; round < kRoundsMax && result.status == SolveStatus::ok; ++round) {
    result.status = inverse(geometry, coupling, result.X_BT, drives_here);
    if (result.status != SolveStatus::ok) break;
    result.residual = 0;
    for (std::size_t i = 0; i < kStruts; ++i)
      result.residual = std::max(result.residual, std::abs(drives_here[i] - drive_lengths[i]));
    result.iterations = iterations;
    if (result.residual <= options.tolerance) return result;
    result.status = lengthening(geometry, coupling, result.X_BT, change);
    if (result.status != SolveStatus::ok) break;
    for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = drive_lengths[i] + change[i];
    // The rounds stop at rounding only when the plain solution is better than what they are to reach.
    ForwardOptions finer = options;
    finer.tolerance = options.tolerance / 4;
    result = forward(geometry, lengths, result.X_BT, finer);
    iterations += result.iterations;
  }
  if (result.status == SolveStatus::ok) result.status = SolveStatus::not_converged;
  result.iterations = iterations;
  return result;
}

}  // namespace understudy::kinematics
