// Hexapod: warm forward kinematics and, by virtual work, strut forces. J holds the gradients of the lengths
// by the platform's twist, so lengths' rates are J V and strut forces f do the work f^T J V:
//   J^T f + Q = 0,   Q the wrench of weights and inertia forces about the tip.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/cross_matrix.h"
#include "core/error.h"
#include "core/units.h"
#include "kinematics/hexapod/hexapod_passive_rotation.h"
#include "sim/plant/hexapod_assembly.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/quasistatic/axis_mechanics.h"
#include "sim/plant/quasistatic/strut_swing.h"

namespace understudy::sim {
namespace {

using kinematics::kStruts;
using kinematics::SolveStatus;
using Vec6 = Eigen::Matrix<double, 6, 1>;

// Chord steps shrink the residual by the distance to the start over a strut's length: from 1 mm off, six
// steps reach rounding. Where they do not, the solver of kinematics decides.
// With screws that turn in their nuts a step leaves a hundredth, and ten reach it.
constexpr int kMaxChordSteps = 10;
constexpr double kTolerance = 1e-12;   // [m], of a strut's length
constexpr double kPivotRatio = 1e-10;  // of J; smaller leaves too few digits

class HexapodMechanics final : public AxisMechanics {
 public:
  HexapodMechanics(const machine::MachineDescription& machine, const AsBuilt& as_built,
                   const QuasistaticOptions& options);

  int axis_count() const override { return kStruts; }
  std::string axis_name(int axis) const override { return fmt::format("strut {}", axis + 1); }
  double axis_zero(int axis) const override { return geometry_.length_offset[axis]; }
  SeriesPlay built_play(int axis) const override;
  kinematics::AxisVector home() const override;

  void start_from_home() override {
    X_BT_ = X_BT_home_;
    factored_ = false;
  }
  SolveStatus place(const AxisVector& position) override;
  Pose tool_pose() const override { return X_WB_ * X_BT_; }
  double closure_error() const override { return closure_; }

  SolveStatus load(const AxisVector& velocity, const AxisVector& acceleration, AxisLoad& load) override;
  void mass_matrix(AxisMatrix& mass) const override;

 private:
  SolveStatus factor();
  Vec6 residual(const AxisVector& position) const;
  Vec6 length_bias(const Twist& V) const;
  Vec6 platform_wrench(const Twist& V, const Twist& A) const;

  kinematics::HexapodGeometry geometry_;
  kinematics::ScrewCoupling coupling_;  ///< a length's rate is taken for the drive's: 1 % of a strut's load
  machine::Masses masses_;
  SwingingBody motor_;
  PerStrut<Vec3> tangent_B_;
  PerStrut<SeriesPlay> play_;
  Pose X_WB_, X_BT_home_;
  Vec3 gravity_B_, nozzle_force_T_;

  Pose X_BT_;
  double closure_ = 0;
  Eigen::PartialPivLU<Mat6> factors_;  ///< of J where it was loaded last: near enough for chord steps
  bool factored_ = false;
  PerStrut<Vec3> arm_B_;       ///< R a_i
  PerStrut<Vec3> strut_B_;     ///< from base joint to ball joint
  PerStrut<double> length_{};  ///< [m]
  PerStrut<StrutSwing> swing_;
};

HexapodMechanics::HexapodMechanics(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                   const QuasistaticOptions& options)
    : geometry_(as_built.hexapod),
      coupling_(built_screw_coupling(machine)),
      masses_(machine.hexapod().masses),
      X_WB_(machine.X_WB),
      X_BT_home_(machine.X_BT_home),
      gravity_B_(machine.X_WB.linear().transpose() * Vec3(0, 0, options.gravity ? -kGravity : 0.0)),
      nozzle_force_T_(options.nozzle_force_T),
      X_BT_(machine.X_BT_home) {
  motor_ = {masses_.motor, cube_moment(masses_.motor)};
  for (int i = 0; i < kStruts; ++i) {
    tangent_B_[i] = Vec3::UnitZ().cross(machine.hexapod().joints.radial_axis[i]).normalized();
    // The nut slides along the screw, the ball along the line between the joints: expressed as strut length,
    // by d(length)/d|d| = |d| / length, which changes by a thousandth over the stroke.
    const Vec3 d = X_BT_home_ * geometry_.platform_joint[i] - geometry_.base_joint[i];
    const double ratio = d.norm() / std::sqrt(d.squaredNorm() - std::pow(geometry_.deviation, 2));
    play_[i].friction = machine.hexapod().play.friction;
    play_[i].damping = kPlayDamping;
    if (options.play) play_[i].inner = as_built.nut_play[i];
    if (options.play) play_[i].outer = as_built.ball_play[i] * ratio;
  }
}

SeriesPlay HexapodMechanics::built_play(int axis) const { return play_[axis]; }

kinematics::AxisVector HexapodMechanics::home() const {
  kinematics::StrutLengths lengths{};
  if (const auto solved = kinematics::inverse(geometry_, coupling_, X_BT_home_, lengths);
      solved != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format("the machine as built cannot take its home pose: {}", to_string(solved)));
  kinematics::AxisVector home{};
  std::copy(lengths.begin(), lengths.end(), home.begin());
  return home;
}

Vec6 HexapodMechanics::residual(const AxisVector& position) const {
  Vec6 r;
  const double dev2 = geometry_.deviation * geometry_.deviation;
  for (int i = 0; i < kStruts; ++i) {
    const Vec3 d = X_BT_ * geometry_.platform_joint[i] - geometry_.base_joint[i];
    r(i) = std::sqrt(d.squaredNorm() - dev2) - position[i];
    if (coupling_.lead == 0) continue;
    double angle = 0;
    if (kinematics::passive_rotation(geometry_, coupling_, X_BT_, i, angle) != kinematics::SolveStatus::ok)
      continue;  // the search goes on by the length alone
    r(i) -= coupling_.lead / (2 * std::numbers::pi) * angle;
  }
  return r;
}

SolveStatus HexapodMechanics::factor() {
  Mat6 J;
  for (int i = 0; i < kStruts; ++i) {
    arm_B_[i] = X_BT_.linear() * geometry_.platform_joint[i];
    strut_B_[i] = X_BT_.translation() + arm_B_[i] - geometry_.base_joint[i];
    length_[i] = std::sqrt(strut_B_[i].squaredNorm() - geometry_.deviation * geometry_.deviation);
    const Vec3 n = strut_B_[i] / length_[i];
    J.block<1, 3>(i, 0) = n.transpose();
    J.block<1, 3>(i, 3) = arm_B_[i].cross(n).transpose();
  }
  factors_.compute(J);
  const Vec6 pivots = factors_.matrixLU().diagonal().cwiseAbs();
  factored_ = pivots.minCoeff() > kPivotRatio * pivots.maxCoeff();
  return factored_ ? SolveStatus::ok : SolveStatus::singular;
}

SolveStatus HexapodMechanics::place(const AxisVector& position) {
  const Pose start = X_BT_;
  if (factored_ || factor() == SolveStatus::ok) {
    for (int step = 0; step <= kMaxChordSteps; ++step) {
      const Vec6 r = residual(position);
      closure_ = r.cwiseAbs().maxCoeff();
      if (closure_ <= kTolerance || !std::isfinite(closure_)) break;
      const Twist change = factors_.solve(-r);
      X_BT_.linear() = exp_rotation(change.tail<3>()) * X_BT_.linear();
      X_BT_.translation() += change.head<3>();
    }
    if (closure_ <= kTolerance) {
      X_BT_.linear() = Quat(X_BT_.linear()).normalized().toRotationMatrix();
      return SolveStatus::ok;
    }
  }
  kinematics::StrutLengths lengths{};
  for (int i = 0; i < kStruts; ++i) lengths[i] = position[i];
  kinematics::ForwardOptions options;
  options.tolerance = kTolerance;
  const auto found = kinematics::forward(geometry_, coupling_, lengths, start, options);
  X_BT_ = found.X_BT;
  factored_ = false;
  closure_ = found.residual;
  return found.status;
}

/// J' V: what the lengths accelerate by when the twist does not.
Vec6 HexapodMechanics::length_bias(const Twist& V) const {
  const Vec3 omega = V.tail<3>();
  Vec6 bias;
  for (int i = 0; i < kStruts; ++i) {
    const Vec3 turn = omega.cross(arm_B_[i]);
    const Vec3 v = V.head<3>() + turn;
    const double rate = strut_B_[i].dot(v) / length_[i];
    bias(i) = (v.squaredNorm() + strut_B_[i].dot(omega.cross(turn)) - rate * rate) / length_[i];
  }
  return bias;
}

Vec6 HexapodMechanics::platform_wrench(const Twist& V, const Twist& A) const {
  const Vec3 omega = V.tail<3>(), omega_rate = A.tail<3>();
  const Mat3& R = X_BT_.linear();
  const Vec3 centre = R * masses_.platform_centre_T;
  const Vec3 acceleration = A.head<3>() + omega_rate.cross(centre) + omega.cross(omega.cross(centre));
  const Vec3 force = masses_.platform * (gravity_B_ - acceleration);
  const Vec3 omega_T = R.transpose() * omega, rate_T = R.transpose() * omega_rate;
  const Vec3& I = masses_.platform_inertia;
  const Vec3 moment_T = I.cwiseProduct(rate_T) + omega_T.cross(I.cwiseProduct(omega_T));
  Vec6 Q;
  Q << force + R * nozzle_force_T_, centre.cross(force) - R * moment_T;
  return Q;
}

SolveStatus HexapodMechanics::load(const AxisVector& velocity, const AxisVector& acceleration,
                                   AxisLoad& load) {
  const SolveStatus status = factor();
  if (status != SolveStatus::ok) return status;
  const Twist V = factors_.solve(Vec6(kinematics::column(velocity, kStruts)));
  const Twist A = factors_.solve(Vec6(kinematics::column(acceleration, kStruts) - length_bias(V)));
  const Vec3 omega = V.tail<3>();
  Vec6 Q = platform_wrench(V, A);
  for (int i = 0; i < kStruts; ++i) {
    StrutSwing& swing = swing_[i];
    if (!find_swing(strut_B_[i], tangent_B_[i], geometry_.deviation, swing)) return SolveStatus::singular;
    const Vec3& arm = arm_B_[i];
    const Vec3 turn = omega.cross(arm);
    const Vec3 v = V.head<3>() + turn;
    const Vec3 a = A.head<3>() + A.tail<3>().cross(arm) + omega.cross(turn);
    const Vec3 force = masses_.nut * (gravity_B_ - a) + swing_force(swing, motor_, v, a, gravity_B_);
    Q.head<3>() += force;
    Q.tail<3>() += arm.cross(force);
    const double nut = (play_[i].outer > 0 ? 1 - kRodEndShare : 1.0) * masses_.nut;
    load.between[i] = nut * (a - gravity_B_).dot(swing.screw_B());
  }
  kinematics::column(load.drive, kStruts) = factors_.transpose().solve(-Q);
  return SolveStatus::ok;
}

void HexapodMechanics::mass_matrix(AxisMatrix& mass) const {
  Mat6 M = Mat6::Zero();
  const auto add = [&](const Mat3& m, const Vec3& p) {
    const Mat3 P = cross_matrix(p);
    M.topLeftCorner<3, 3>() += m;
    M.topRightCorner<3, 3>() -= m * P;
    M.bottomLeftCorner<3, 3>() += P * m;
    M.bottomRightCorner<3, 3>() -= P * m * P;
  };
  const Mat3& R = X_BT_.linear();
  add(masses_.platform * Mat3::Identity(), R * masses_.platform_centre_T);
  M.bottomRightCorner<3, 3>() += R * masses_.platform_inertia.asDiagonal() * R.transpose();
  for (int i = 0; i < kStruts; ++i)
    add(masses_.nut * Mat3::Identity() + swing_inertia(swing_[i], motor_), arm_B_[i]);
  const Mat6 inverse = factors_.inverse();
  mass = inverse.transpose() * M * inverse;
}

}  // namespace

std::unique_ptr<AxisMechanics> make_hexapod_mechanics(const machine::MachineDescription& machine,
                                                      const AsBuilt& as_built,
                                                      const QuasistaticOptions& options) {
  return std::make_unique<HexapodMechanics>(machine, as_built, options);
}

}  // namespace understudy::sim
