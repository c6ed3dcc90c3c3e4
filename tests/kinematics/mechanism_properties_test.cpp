// What holds for every mechanism, whatever its dimensions and manufacturing deviations.
#include "kinematics/mechanism.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/finishing.h"
#include "kinematics/chain/five_axis.h"
#include "tests/kinematics/chain/arm_machines.h"
#include "tests/kinematics/hexapod/g4.h"
#include "tests/kinematics/rate_check.h"
#include "tests/property.h"

namespace understudy::kinematics {
namespace {

using property::real;

constexpr double kPi = std::numbers::pi;

/// A machine of random dimensions and a place in its workspace.
struct Drawn {
  std::unique_ptr<Mechanism> mechanism;
  Chain chain;        ///< of a chain
  AxisVector axes{};  ///< within their ranges
  Pose X_BT = Pose::Identity();
};

HexapodGeometry drawn_hexapod() {
  HexapodGeometry g = nominal_g4(*real(0, 0.015));
  for (std::size_t i = 0; i < kStruts; ++i) {
    g.base_joint[i] += *property::vector(1e-3);
    g.platform_joint[i] += *property::vector(1e-3);
  }
  return g;
}

// The workspace of machine G4: 30 mm about home, leaning by 20 degrees, turned by 20.
Drawn hexapod() {
  const HexapodGeometry g = drawn_hexapod();
  Drawn drawn;
  drawn.mechanism = make_hexapod(g, joints_at_home(g, Pose::Identity()), limits_g4(), Pose::Identity());
  const double tilt = *real(0, from_deg(20)), azimuth = *real(-kPi, kPi), spin = *real(-0.35, 0.35);
  const Pose upright = make_pose(exp_rotation(Vec3(0, 0, spin)), *property::vector(0.03));
  drawn.X_BT = upright * tilted(Vec3::Zero(), tilt, azimuth);
  RC_ASSERT(drawn.mechanism->inverse(drawn.X_BT, {}, drawn.axes) == SolveStatus::ok);
  return drawn;
}

Drawn at_axes(const ChainDescription& d, const AxisVector& axes) {
  Drawn drawn;
  drawn.mechanism = make_chain_mechanism(d);
  drawn.chain = d.chain;
  drawn.axes = axes;
  drawn.X_BT = forward(d.chain, std::span(axes).first(d.chain.axes.size()));
  return drawn;
}

AxisVector drawn_axes(const std::vector<AxisRange>& ranges) {
  AxisVector axes{};
  for (std::size_t i = 0; i < ranges.size(); ++i) axes[i] = *real(ranges[i].lower, ranges[i].upper);
  return axes;
}

Drawn arm() {
  ChainDescription d = sv3x();
  for (std::size_t i = 0; i + 1 < d.parameters.size(); ++i) d.parameters[i] += *real(-5e-3, 5e-3);
  d.parameters.back() += *real(-0.1, 0.1);
  const std::vector<ChainAxis> limits = d.chain.axes;
  d.chain = arm_chain(arm_geometry(d.parameters));
  std::vector<AxisRange> ranges;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    d.chain.axes[i].lower = limits[i].lower;
    d.chain.axes[i].upper = limits[i].upper;
    ranges.push_back({limits[i].lower, limits[i].upper});
  }
  const AxisVector axes = drawn_axes(ranges);
  // A singular posture has no one answer.
  const ArmClearance room = arm_clearance(arm_geometry(d.parameters), std::span(axes).first(kArmAxes));
  RC_PRE(room.wrist > kArmClearanceMin.wrist && room.elbow > kArmClearanceMin.elbow &&
         room.shoulder > kArmClearanceMin.shoulder);
  return at_axes(d, axes);
}

// Axes off their drawn lines, as on a machine that was measured: no closed form fits.
Drawn measured_arm() {
  ChainDescription d = sv3x();
  d.design = d.chain;
  for (ChainAxis& axis : d.chain.axes) {
    axis.point += *property::vector(1e-3);
    axis.direction = (exp_rotation(*property::vector(3e-3)) * axis.direction).normalized();
  }
  d.chain.X_OT_zero.translation() += *property::vector(1e-3);
  AxisVector axes = drawn_axes({{-2, 2}, {-0.3, 1}, {-0.6, 0.6}, {-1.5, 1.5}, {0.4, 1.6}, {-3, 3}});
  return at_axes(d, axes);
}

Drawn five_axis() {
  const FiveAxisGeometry g{*real(-0.05, 0.05), *real(-0.05, 0.05), *real(-0.05, 0.05), *real(-0.05, 0.05)};
  ChainDescription d;
  d.kind = "five-axis";
  d.parameters = {g.b_axis_x, g.b_axis_z, g.c_axis_x, g.c_axis_y};
  d.chain = five_axis_chain(g);
  d.home = {0, 0, 0.1, 0, 0};
  // Upright, C turns nothing.
  const double side = *rc::gen::element(-1.0, 1.0);
  AxisVector axes = drawn_axes({{-0.1, 0.1}, {-0.1, 0.1}, {0, 0.2}, {0.2, kPi - 0.2}, {-9, 9}});
  axes[3] *= side;
  return at_axes(d, axes);
}

Drawn finishing() {
  const FinishingGeometry g{*real(0.1, 0.4), *real(0.02, 0.15)};
  ChainDescription d;
  d.kind = "finishing";
  d.parameters = {g.l3, g.le};
  d.chain = finishing_chain(g);
  return at_axes(d,
                 drawn_axes({{-0.2, 0.2}, {-kPi, kPi}, {-0.1, 0.1}, {-0.1, 0.1}, {-1.4, 1.4}, {-1.2, 1.2}}));
}

/// What a case that fails was about.
void log(const Drawn& drawn) {
  RC_LOG() << "axes:";
  for (int i = 0; i < drawn.mechanism->axis_count(); ++i)
    RC_LOG() << " " << drawn.axes[static_cast<std::size_t>(i)];
  RC_LOG() << "\npose:\n" << drawn.X_BT.matrix() << "\n";
}

// The tip and what of the orientation is the machine's to choose. Newton ends within 1e-12 m and rad.
constexpr double kPoseError = 1e-10;

double pose_error(const Mechanism& mechanism, const Pose& a, const Pose& b) {
  const double turn =
      mechanism.follows_spin() ? angle_between(a.linear(), b.linear()) : (tool_axis(a) - tool_axis(b)).norm();
  return std::max((a.translation() - b.translation()).norm(), turn);
}

using Draw = Drawn (*)();

void inverse_then_forward_is_the_pose(Draw draw) {
  property::check({1000}, [draw] {
    const Drawn drawn = draw();
    log(drawn);
    AxisVector axes{};
    RC_ASSERT(drawn.mechanism->inverse(drawn.X_BT, {}, axes) == SolveStatus::ok);
    Pose X_found = Pose::Identity();
    RC_ASSERT(drawn.mechanism->forward(axes, drawn.mechanism->home(), X_found) == SolveStatus::ok);
    RC_ASSERT(pose_error(*drawn.mechanism, X_found, drawn.X_BT) < kPoseError);
  });
}

TEST(MechanismProperties, InverseThenForwardIsThePoseOfAHexapod) {
  inverse_then_forward_is_the_pose(hexapod);
}
TEST(MechanismProperties, InverseThenForwardIsThePoseOfAnArm) { inverse_then_forward_is_the_pose(arm); }
TEST(MechanismProperties, InverseThenForwardIsThePoseOfAMeasuredArm) {
  inverse_then_forward_is_the_pose(measured_arm);
}
TEST(MechanismProperties, InverseThenForwardIsThePoseOfAFiveAxisMachine) {
  inverse_then_forward_is_the_pose(five_axis);
}
TEST(MechanismProperties, InverseThenForwardIsThePoseOfAFinishingStage) {
  inverse_then_forward_is_the_pose(finishing);
}

// Beside axes that make the pose the inverse finds these axes: the same branch, the same turns. An arm near
// its limits of clearance turns an axis 50 times as far as the pose errs.
void forward_then_inverse_is_the_axes(Draw draw, double tolerance) {
  property::check({1000}, [=] {
    const Drawn drawn = draw();
    log(drawn);
    Pose X = Pose::Identity();
    RC_ASSERT(drawn.mechanism->forward(drawn.axes, drawn.X_BT, X) == SolveStatus::ok);
    RC_ASSERT(pose_error(*drawn.mechanism, X, drawn.X_BT) < kPoseError);
    AxisVector axes{};
    RC_ASSERT(drawn.mechanism->inverse(X, drawn.axes, axes) == SolveStatus::ok);
    for (std::size_t i = 0; i < axes.size(); ++i) RC_ASSERT(std::abs(axes[i] - drawn.axes[i]) < tolerance);
  });
}

TEST(MechanismProperties, ForwardThenInverseIsTheAxesOfAHexapod) {
  forward_then_inverse_is_the_axes(hexapod, 1e-12);
}
TEST(MechanismProperties, ForwardThenInverseIsTheAxesOfAnArm) { forward_then_inverse_is_the_axes(arm, 1e-9); }
TEST(MechanismProperties, ForwardThenInverseIsTheAxesOfAMeasuredArm) {
  forward_then_inverse_is_the_axes(measured_arm, 1e-9);
}
TEST(MechanismProperties, ForwardThenInverseIsTheAxesOfAFiveAxisMachine) {
  forward_then_inverse_is_the_axes(five_axis, 1e-10);
}
// Six axes for five dimensions: the axes that are there already are the nearest.
TEST(MechanismProperties, ForwardThenInverseIsTheAxesOfAFinishingStage) {
  forward_then_inverse_is_the_axes(finishing, 1e-9);
}

// Truncation grows with the third derivative, which is large near singular poses (rate_check.h): 1e-6 at a
// condition of 50 and a rate of that size.
void rates_are_derivatives(Draw draw) {
  property::check({500}, [draw] {
    const Drawn drawn = draw();
    log(drawn);
    RC_PRE(drawn.mechanism->condition_number(drawn.X_BT, drawn.axes) < 30);
    RC_ASSERT(worst_rate_difference(*drawn.mechanism, drawn.X_BT, drawn.axes) < 1e-6);
  });
}

TEST(MechanismProperties, RatesOfAHexapodAreDerivatives) { rates_are_derivatives(hexapod); }
TEST(MechanismProperties, RatesOfAnArmAreDerivatives) { rates_are_derivatives(arm); }
TEST(MechanismProperties, RatesOfAMeasuredArmAreDerivatives) { rates_are_derivatives(measured_arm); }
TEST(MechanismProperties, RatesOfAFiveAxisMachineAreDerivatives) { rates_are_derivatives(five_axis); }
TEST(MechanismProperties, RatesOfAFinishingStageAreDerivatives) { rates_are_derivatives(finishing); }

// Central differences of 1e-6: h^2 times a third derivative below 1, and 1e-16 / h of rounding.
TEST(MechanismProperties, TheJacobianOfAChainIsItsDerivative) {
  property::check({1000}, [] {
    constexpr Draw kChains[] = {arm, measured_arm, five_axis, finishing};
    const Drawn drawn = kChains[*property::whole(0, 3)]();
    log(drawn);
    constexpr double h = 1e-6;
    const std::size_t count = drawn.chain.axes.size();
    ChainJacobian J;
    const Pose X = forward(drawn.chain, std::span(drawn.axes).first(count), J);
    for (std::size_t axis = 0; axis < count; ++axis) {
      const auto moved = [&](double by) {
        AxisVector axes = drawn.axes;
        axes[axis] += by;
        return forward(drawn.chain, std::span(axes).first(count));
      };
      const Pose ahead = moved(h), behind = moved(-h);
      Twist expected;
      expected << (ahead.translation() - behind.translation()) / (2 * h),
          log_rotation(ahead.linear() * behind.linear().transpose()) / (2 * h);
      RC_ASSERT((J.col(static_cast<Eigen::Index>(axis)) - expected).norm() < 1e-8);
    }
    RC_ASSERT(pose_error(*drawn.mechanism, X, drawn.X_BT) < 1e-14);
  });
}

// Turning the whole machine turns its poses and nothing else.
TEST(MechanismProperties, AHexapodMovedAsAWholeHasTheSameStruts) {
  property::check({1000}, [] {
    const HexapodGeometry g = drawn_hexapod();
    const Pose X_BT = tilted(*property::vector(0.02), *real(0, 0.3), *real(-kPi, kPi));
    const Pose X_MB = make_pose(exp_rotation(*property::vector(1.5)), *property::vector(1));
    HexapodGeometry moved = g;
    for (Vec3& joint : moved.base_joint) joint = X_MB * joint;
    StrutLengths here{}, there{};
    RC_ASSERT(inverse(g, X_BT, here) == SolveStatus::ok);
    RC_ASSERT(inverse(moved, X_MB * X_BT, there) == SolveStatus::ok);
    for (std::size_t i = 0; i < kStruts; ++i) RC_ASSERT(std::abs(here[i] - there[i]) < 1e-14);
  });
}

}  // namespace
}  // namespace understudy::kinematics
