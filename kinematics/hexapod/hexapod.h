// Stewart platform with a base above and a hanging platform (Song 2015, eqs 1-5;
// docs/reference.md#hexapod-kinematics).
//   d_i = b_i - p - R a_i,   length_i = sqrt(|d_i|^2 - dev^2),   displacement_i = length_i - l_i0.
// Axes are strut lengths [m], not displacements.
#pragma once

#include <array>
#include <memory>

#include "kinematics/mechanism.h"

namespace understudy::kinematics {

constexpr int kStruts = 6;
constexpr const char* kHexapod = "hexapod";  ///< word of `mechanism:` in a machine file
template <typename T>
using PerStrut = std::array<T, kStruts>;
/// The same for every strut.
template <typename T>
PerStrut<T> on_every_strut(const T& value) {
  return {value, value, value, value, value, value};
}
using StrutLengths = PerStrut<double>;  ///< [m]

/// The 42 parameters b_i, a_i, l_i0 and the deviation `dev`. Immutable in use; [m].
struct HexapodGeometry {
  PerStrut<Vec3> base_joint = on_every_strut<Vec3>(Vec3::Zero());      ///< b_i, p_BBi
  PerStrut<Vec3> platform_joint = on_every_strut<Vec3>(Vec3::Zero());  ///< a_i, p_TPi: from the nozzle tip
  StrutLengths length_offset{};  ///< l_i0: strut length at drive displacement 0
  double deviation = 0;          ///< dev: distance of the screw's axis from the base joint
};

/// What the joints and struts allow. Angles by the definitions of docs/reference.md#joint-angles.
struct HexapodLimits {
  double strut_min = 0, strut_max = 0;            ///< [m]
  double base_alpha_min = 0, base_alpha_max = 0;  ///< [rad], positive inward
  double base_beta_max = 0;                       ///< [rad], lateral, both ways
  double ball_min = 0, ball_max = 0;              ///< [rad], from the stud axis
  double screw_distance_min = 0;                  ///< [m], between the axes of two screws
  double condition_max = 0;                       ///< of J with lengths scaled by the platform radius
};

/// Joint angles at a pose. `stud` is fixed to the platform, `radial` to the base.
struct HexapodJoints {
  PerStrut<Vec3> stud_axis;    ///< unit, in T
  PerStrut<Vec3> radial_axis;  ///< e_r, unit, in B
};

struct StrutAngles {
  double alpha, beta, ball;
};  ///< [rad]

/// Eqs 3-4. `unreachable` when |d| < dev for a strut, `bad_input` for a pose that is not finite.
SolveStatus inverse(const HexapodGeometry& geometry, const Pose& X_BT, StrutLengths& lengths);

struct ForwardOptions {
  double tolerance = 1e-13;  ///< [m], largest length residual
  int max_iterations = 20;
};
struct ForwardResult {
  SolveStatus status = SolveStatus::not_converged;
  Pose X_BT = Pose::Identity();
  int iterations = 0;
  double residual = 0;  ///< [m], largest length residual at X_BT
};
/// Newton on SE(3) from `seed`: the increment is a twist, not added to angles. Never throws; the result says
/// what happened, X_BT is then the last iterate (the seed, or identity, on bad input) and always finite.
///
/// Branch: six lengths have up to 40 assemblies. The answer is one that is reached from the seed by steps of
/// at most 0.6 rad and half a strut, each with a smaller residual and the sign of det J unchanged, so no step
/// passes from one side of a singularity to the other. Seed: the last known pose, or home. ok: residual <=
/// tolerance. singular: J has no inverse at an iterate, or every shorter step still changes the sign of det
/// J. not_converged: the residual stopped falling (no pose near has these lengths) or the cap
/// `max_iterations` was met. unreachable: a strut of the seed is shorter than dev. bad_input: a length that
/// is not finite and positive, or a seed that is not a rigid pose.
ForwardResult forward(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& seed,
                      const ForwardOptions& options = {});

/// d(lengths)/d(twist): row i = [n, (R a_i) x n] with n the gradient of the length by p; twist in B at the
/// tip.
SolveStatus jacobian(const HexapodGeometry& geometry, const Pose& X_BT, Mat6& J);

/// Mean horizontal distance of the platform joints from the tool's axis: the length that makes J
/// dimensionless.
double platform_radius(const HexapodGeometry& geometry);

/// Of J with its angular columns divided by platform_radius; kSingularCondition where there is no inverse.
double condition_number(const HexapodGeometry& geometry, const Pose& X_BT);

/// Shortest distance between two struts, each the segment from its base joint to its ball joint [m].
double screw_distance(const HexapodGeometry& geometry, const Pose& X_BT, int strut, int other);

/// Angles of `strut` (from 0) by the definitions of docs/reference.md#joint-angles, with u the unit vector
/// from base to ball joint: alpha = atan2(-u.e_r, -u.e_z), beta = asin(u.e_t), ball = acos(-u.R a).
StrutAngles strut_angles(const HexapodGeometry& geometry, const HexapodJoints& joints, const Pose& X_BT,
                         int strut);

/// Stud axes of machine G4: the radial direction made perpendicular to the strut at home
/// (docs/reference.md#machine-g4).
HexapodJoints joints_at_home(const HexapodGeometry& geometry, const Pose& X_BT_home);

/// Appends a violation for every limit that the pose breaks. Struts and joints are numbered from 1 in `part`.
void check(const HexapodGeometry& geometry, const HexapodJoints& joints, const HexapodLimits& limits,
           const Pose& X_BT, std::vector<LimitViolation>& violations);

/// The same behind the common interface.
std::unique_ptr<Mechanism> make_hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints,
                                        const HexapodLimits& limits, const Pose& X_BT_home);

}  // namespace understudy::kinematics
