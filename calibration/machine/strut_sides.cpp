#include "calibration/machine/strut_sides.h"

#include <Eigen/LU>
#include <cmath>

#include "core/distributions.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using machine::HexapodModel;

constexpr double kCables = 0.1;  // [N] that cables pull, and other loads that the description does not have
constexpr double kSure = 3;      // sigma

/// The side of a play by its strut's load.
struct SidesByLoad {
  explicit SidesByLoad(const HexapodModel& hexapod) : nut(kGravity * hexapod.masses.nut) {
    const double both = hexapod.play.ball_joint + hexapod.play.screw_nut;
    // The nut hangs in its screw while the rod, which it carries, stands on it.
    between = both > 0 ? (hexapod.play.ball_joint - hexapod.play.screw_nut) / both : 0;
  }
  double side(double load) const { return load > 0 ? 1 : load < -nut ? -1 : between; }

  double nut;  ///< [N], its weight
  double between = 0;
};

/// Of a motor, which stands off by dev from its universal joint, when the ball joint is at d_B from there.
/// Its first axis is `tangent_B`.
Vec3 motor_place(const Vec3& d_B, const Vec3& tangent_B, double deviation) {
  const Vec3 across = d_B - d_B.dot(tangent_B) * tangent_B;
  const double leg = std::sqrt(std::max(0.0, across.squaredNorm() - deviation * deviation));
  return deviation * (deviation * across + leg * across.cross(tangent_B)) / across.squaredNorm();
}

/// What the motor's weight does at the ball joint: minus the slope of its potential energy.
Vec3 motor_force(const Vec3& d_B, const Vec3& tangent_B, double deviation, const Vec3& weight_B) {
  constexpr double kStep = 1e-5;  // [m]: central differences err by its square
  Vec3 force;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vec3 step = kStep * Vec3::Unit(k);
    force[k] = weight_B.dot(motor_place(d_B + step, tangent_B, deviation) -
                            motor_place(d_B - step, tangent_B, deviation)) /
               (2 * kStep);
  }
  return force;
}

/// The loads where the drives stand as for X_BT on `geometry`, and the machine is `off`.
bool loads_when_off(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                    const kinematics::HexapodGeometry& off, const Pose& X_BT, StrutLengths& load) {
  StrutLengths lengths;
  if (kinematics::inverse(geometry, X_BT, lengths) != kinematics::SolveStatus::ok) return false;
  for (std::size_t i = 0; i < kStruts; ++i) lengths[i] += off.length_offset[i] - geometry.length_offset[i];
  const auto stands = kinematics::forward(off, lengths, X_BT);
  return stands.status == kinematics::SolveStatus::ok && strut_loads(machine, off, stands.X_BT, load);
}

}  // namespace

bool load_sigmas(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                 const machine::ToleranceSet& tolerances, const Pose& X_BT, StrutLengths& sigma) {
  constexpr double kStep = 1e-5;  // [m]: loads are smooth over millimetres
  StrutLengths at;
  if (!strut_loads(machine, geometry, X_BT, at)) return false;
  StrutLengths variance{};
  const auto add = [&](const kinematics::HexapodGeometry& off, double tolerance) {
    StrutLengths load;
    if (!loads_when_off(machine, geometry, off, X_BT, load)) return false;
    for (std::size_t i = 0; i < kStruts; ++i)
      variance[i] += std::pow((load[i] - at[i]) / kStep * tolerance, 2);
    return true;
  };
  for (std::size_t i = 0; i < kStruts; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      kinematics::HexapodGeometry base = geometry, platform = geometry;
      base.base_joint[i][k] += kStep;
      platform.platform_joint[i][k] += kStep;
      if (!add(base, tolerances.joint_position) || !add(platform, tolerances.joint_position)) return false;
    }
    kinematics::HexapodGeometry off = geometry;
    off.length_offset[i] += kStep;
    if (!add(off, tolerances.length_offset)) return false;
  }
  for (std::size_t i = 0; i < kStruts; ++i) sigma[i] = std::sqrt(variance[i]);
  return true;
}

bool strut_loads(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                 const Pose& X_BT, StrutLengths& load) {
  const HexapodModel& hexapod = machine.hexapod();
  Mat6 J;
  if (kinematics::jacobian(geometry, X_BT, J) != kinematics::SolveStatus::ok) return false;
  const Vec3 gravity_B = machine.X_WB.linear().transpose() * Vec3(0, 0, -kGravity);
  const auto wrench = [](const Vec3& arm, const Vec3& force) {
    Twist w;
    w << force, arm.cross(force);
    return w;
  };
  Twist Q = wrench(X_BT.linear() * hexapod.masses.platform_centre_T, hexapod.masses.platform * gravity_B);
  for (std::size_t i = 0; i < kStruts; ++i) {
    const Vec3 arm = X_BT.linear() * geometry.platform_joint[i];
    const Vec3 d_B = X_BT.translation() + arm - geometry.base_joint[i];
    const Vec3 tangent_B = Vec3::UnitZ().cross(hexapod.joints.radial_axis[i]).normalized();
    Q += wrench(arm, hexapod.masses.nut * gravity_B +
                         motor_force(d_B, tangent_B, geometry.deviation, hexapod.masses.motor * gravity_B));
  }
  const Eigen::FullPivLU<Mat6> factors(J.transpose());
  if (!factors.isInvertible()) return false;
  const Twist forces = factors.solve(-Q);
  for (std::size_t i = 0; i < kStruts; ++i) load[i] = forces[static_cast<Eigen::Index>(i)];
  return forces.allFinite();
}

kinematics::PerStrut<double> probable_sides(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_BT) {
  kinematics::PerStrut<double> sides{};
  StrutLengths load;
  if (!strut_loads(machine, geometry, X_BT, load)) return sides;
  const SidesByLoad by(machine.hexapod());
  for (std::size_t i = 0; i < kStruts; ++i) sides[i] = by.side(load[i]);
  return sides;
}

bool side_variances(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                    const machine::ToleranceSet& tolerances, const Pose& X_BT,
                    kinematics::PerStrut<double>& variance) {
  StrutLengths load, sigma;
  if (!strut_loads(machine, geometry, X_BT, load) || !load_sigmas(machine, geometry, tolerances, X_BT, sigma))
    return false;
  const SidesByLoad by(machine.hexapod());
  const double friction = machine.hexapod().play.friction / std::sqrt(3.0);  // of an even distribution
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double spread = std::hypot(sigma[i], kCables / kSure, friction), side = by.side(load[i]);
    const double pulls = normal_below((-by.nut - load[i]) / spread), pushes = normal_below(load[i] / spread);
    variance[i] = pushes * std::pow(1 - side, 2) + pulls * std::pow(-1 - side, 2) +
                  (1 - pushes - pulls) * std::pow(by.between - side, 2);
  }
  return true;
}

kinematics::PerStrut<Approach> resting_sides(const machine::MachineDescription& machine,
                                             const kinematics::HexapodGeometry& geometry,
                                             const machine::ToleranceSet& tolerances, const Pose& X_BT) {
  kinematics::PerStrut<Approach> sides{};
  StrutLengths load, sigma;
  if (!strut_loads(machine, geometry, X_BT, load) || !load_sigmas(machine, geometry, tolerances, X_BT, sigma))
    return sides;
  const HexapodModel& hexapod = machine.hexapod();
  const double nut = kGravity * hexapod.masses.nut;
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double margin = hexapod.play.friction + kCables + kSure * sigma[i];
    if (load[i] > margin) sides[i] = Approach::lengthening;
    if (load[i] < -nut - margin) sides[i] = Approach::shortening;
  }
  return sides;
}

int note_sides(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
               const Pose& X_BT, kinematics::PerStrut<Approach>& sides) {
  const auto told = resting_sides(machine, geometry, machine.tolerances.after_calibration, X_BT);
  int noted = 0;
  for (std::size_t i = 0; i < kStruts; ++i) {
    if (sides[i] != Approach::unknown || told[i] == Approach::unknown) continue;
    sides[i] = told[i];
    ++noted;
  }
  return noted;
}

}  // namespace understudy::calibration
