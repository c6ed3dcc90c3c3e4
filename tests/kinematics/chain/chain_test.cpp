#include "kinematics/chain/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/random_vector.h"
#include "kinematics/chain/chain_mechanism.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/chain/arm_machines.h"

namespace understudy::kinematics {
namespace {

using Eigen::Matrix4d;
using Axes = AxisVector;
using Rates = Eigen::Matrix<double, Eigen::Dynamic, 6>;

Vec3 random_vector(Random& random, double size) { return uniform_vec3(random, size); }

/// Slides and turns in any direction, some of them under the work; all of it by chance.
Chain random_chain(Random& random, int size) {
  Chain chain;
  for (int i = 0; i < size; ++i) {
    ChainAxis axis;
    axis.angle = random.uniform() < 0.6;
    axis.direction = random_vector(random, 1).normalized();
    axis.point = random_vector(random, 0.5);
    const bool for_work = random.uniform() < 0.4;
    axis.parent = for_work ? chain.work_axis : chain.tool_axis;
    (for_work ? chain.work_axis : chain.tool_axis) = i;
    chain.axes.push_back(axis);
  }
  chain.X_OT_zero = make_pose(exp_rotation(random_vector(random, 2)), random_vector(random, 0.5));
  chain.X_OS_zero = make_pose(exp_rotation(random_vector(random, 2)), random_vector(random, 0.5));
  return chain;
}

Axes random_axes_of(Random& random, double size) {
  Axes q{};
  for (double& v : q) v = random.uniform(-size, size);
  return q;
}

/// exp of the axis' screw by the matrix exponential of its 4x4 twist (Yu 2023, eq 2; v = -omega x point).
Matrix4d screw_by_exponential(const ChainAxis& axis, double q) {
  Matrix4d twist = Matrix4d::Zero();
  if (axis.angle) {
    const Vec3 w = axis.direction;
    twist.topLeftCorner<3, 3>() << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    twist.topRightCorner<3, 1>() = -w.cross(axis.point);
  } else {
    twist.topRightCorner<3, 1>() = axis.direction;
  }
  return (twist * q).exp();
}

Matrix4d branch_by_exponentials(const Chain& chain, int last, const Axes& q, const Pose& X_zero) {
  Matrix4d X = X_zero.matrix();
  for (int i = last; i >= 0; i = chain.axes[static_cast<std::size_t>(i)].parent) {
    const auto k = static_cast<std::size_t>(i);
    X = screw_by_exponential(chain.axes[k], q[k]) * X;
  }
  return X;
}

// Twenty products of matrices of entries about 1.
TEST(Chain, ForwardIsTheProductOfMatrixExponentials) {
  Random random(41, "chain forward");
  for (int n = 0; n < 300; ++n) {
    const Chain chain = random_chain(random, 1 + n % kMaxAxes);
    const Axes q = random_axes_of(random, 2);
    const Matrix4d X_OS = branch_by_exponentials(chain, chain.work_axis, q, chain.X_OS_zero);
    const Matrix4d X_OT = branch_by_exponentials(chain, chain.tool_axis, q, chain.X_OT_zero);
    const Matrix4d expected = X_OS.inverse() * X_OT;
    EXPECT_LE((forward(chain, q).matrix() - expected).cwiseAbs().maxCoeff(), 1e-13);
  }
}

// Central differences, h = 1e-5: truncation h^2/6 times a third derivative of some metres, rounding 1e-16/h.
TEST(Chain, JacobianIsTheDerivativeOfForward) {
  Random random(42, "chain jacobian");
  const double h = 1e-5;
  for (int n = 0; n < 500; ++n) {
    const Chain chain = random_chain(random, 1 + n % kMaxAxes);
    const Axes q = random_axes_of(random, 2);
    ChainJacobian J;
    const Pose X = forward(chain, q, J);
    EXPECT_EQ(X.matrix(), forward(chain, q).matrix());
    for (int i = 0; i < chain.size(); ++i) {
      Axes ahead = q, behind = q;
      ahead[static_cast<std::size_t>(i)] += h;
      behind[static_cast<std::size_t>(i)] -= h;
      const Pose X_ahead = forward(chain, ahead), X_behind = forward(chain, behind);
      const Vec3 v = (X_ahead.translation() - X_behind.translation()) / (2 * h);
      const Vec3 omega =
          X_behind.linear() * log_rotation(X_behind.linear().transpose() * X_ahead.linear()) / (2 * h);
      EXPECT_LE((J.col(i).head<3>() - v).norm(), 1e-9);
      EXPECT_LE((J.col(i).tail<3>() - omega).norm(), 1e-9);
    }
  }
}

void expect_pose(const Mechanism& machine, const Axes& axes, const Pose& X, double tolerance) {
  Pose reached = Pose::Identity();
  ASSERT_EQ(machine.forward(axes, Pose::Identity(), reached), SolveStatus::ok);
  EXPECT_LE(position_error(reached, X), tolerance);
  if (machine.follows_spin())
    EXPECT_LE(angle_between(reached.linear(), X.linear()), tolerance);
  else
    EXPECT_LE((tool_axis(reached) - tool_axis(X)).norm(), tolerance);
}

/// Poses of random postures over the whole range: all are solved from home to the solver's own tolerance.
void expect_all_solved(const ChainDescription& d, int cases, std::uint64_t seed) {
  Random random(seed, "chain inverse");
  const auto machine = make_chain_mechanism(d);
  for (int n = 0; n < cases; ++n) {
    Axes q{}, found{};
    for (std::size_t i = 0; i < d.chain.axes.size(); ++i)
      q[i] = random.uniform(std::max(d.chain.axes[i].lower, -3.1), std::min(d.chain.axes[i].upper, 3.1));
    const Pose X = forward(d.chain, q);
    ASSERT_EQ(machine->inverse(X, {}, found), SolveStatus::ok) << "case " << n;
    // 1e-12 is the solver's; turning back by whole turns rounds by 1e-15.
    expect_pose(*machine, found, X, 1.1e-12);
    for (std::size_t i = 0; i < d.chain.axes.size(); ++i) {
      EXPECT_GE(found[i], d.chain.axes[i].lower);
      EXPECT_LE(found[i], d.chain.axes[i].upper);
    }
  }
}
TEST(OpenChain, EveryPoseOfAnArmWithoutASphericalWristIsSolvedFromHome) {
  expect_all_solved(offset_wrist_arm(), 1000, 43);
}
TEST(OpenChain, EveryPoseOfAnArmWithASphericalWristIsSolvedWithoutItsClosedForm) {
  ChainDescription d = sv3x();
  d.kind = "chain";
  expect_all_solved(d, 300, 44);
}
TEST(SlowOpenChain, AHundredThousandPosesAreSolvedFromHome) {
  expect_all_solved(offset_wrist_arm(), 100'000, 45);
}

/// Four axes, two of them under the work: turn and slide of the table, turn and slide of the head.
ChainDescription four_axes() {
  ChainDescription d;
  d.kind = "chain";
  const auto axis = [&](const char* name, bool angle, const Vec3& direction, const Vec3& point, int parent) {
    d.chain.axes.push_back({name, angle, direction, point, parent, angle ? -3.0 : -0.3, angle ? 3.0 : 0.3});
  };
  axis("x", false, Vec3::UnitX(), Vec3::Zero(), -1);
  axis("c", true, Vec3::UnitZ(), Vec3(0.1, 0, 0), 0);
  axis("z", false, Vec3::UnitZ(), Vec3::Zero(), -1);
  axis("b", true, Vec3::UnitY(), Vec3(0, 0, 0.3), 2);
  d.chain.work_axis = 1;
  d.chain.tool_axis = 3;
  d.chain.X_OT_zero.translation() = Vec3(0.05, 0, 0.1);
  d.home = {0, 0, 0, 0.5};
  return d;
}

TEST(OpenChain, FewerThanSixAxesFollowTipAndToolAxisOnly) {
  const ChainDescription d = four_axes();
  const auto machine = make_chain_mechanism(d);
  EXPECT_FALSE(machine->follows_spin());
  Random random(46, "four axes");
  for (int n = 0; n < 300; ++n) {
    Axes q{}, found{};
    for (std::size_t i = 0; i < 4; ++i) q[i] = random.uniform(d.chain.axes[i].lower, d.chain.axes[i].upper);
    Pose X = forward(d.chain, q);
    X.linear() = (X.linear() * exp_rotation({0, 0, random.uniform(-2, 2)})).eval();  // another spin
    ASSERT_EQ(machine->inverse(X, q, found), SolveStatus::ok) << n;
    expect_pose(*machine, found, X, 1.1e-12);
  }
  // Four axes cannot tilt the tool sideways.
  Pose X = machine->home();
  X.linear() = (exp_rotation({0.2, 0, 0}) * X.linear()).eval();
  Axes found{};
  EXPECT_EQ(machine->inverse(X, {}, found), SolveStatus::unreachable);
}

TEST(OpenChain, ConvergesQuadratically) {
  const ChainDescription d = offset_wrist_arm();
  Axes q{};
  std::copy(d.home.begin(), d.home.end(), q.begin());
  const Pose X = forward(d.chain, q);
  for (std::size_t i = 0; i < 6; ++i) q[i] += i % 2 ? 0.02 : -0.02;
  ASSERT_EQ(solve_numerically(d.chain, X, true, d.length_scale, q), SolveStatus::ok);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(q[i], d.home[i], 1e-11);  // 1e-12 over the arm's conditioning
}

// The path is made in the axes; the inverse, that sees poses only, must give them back.
TEST(OpenChain, StaysWithItsSolutionAlongAPath) {
  const ChainDescription d = offset_wrist_arm();
  const auto machine = make_chain_mechanism(d);
  Axes previous{};
  std::copy(d.home.begin(), d.home.end(), previous.begin());
  for (int n = 0; n <= 2000; ++n) {
    const double t = 2 * std::numbers::pi * n / 2000;
    Axes q{}, found{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = d.home[i] + 0.4 * std::sin(static_cast<double>(i + 2) * t);
    ASSERT_EQ(machine->inverse(forward(d.chain, q), previous, found), SolveStatus::ok);
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(found[i], q[i], 1e-9) << "step " << n;
    previous = found;
  }
}

TEST(OpenChain, KeepsTheTurnOfThePreviousAxes) {
  const ChainDescription d = offset_wrist_arm();
  const auto machine = make_chain_mechanism(d);
  Axes q{}, found{};
  std::copy(d.home.begin(), d.home.end(), q.begin());
  q[5] = 5.5;
  ASSERT_EQ(machine->inverse(forward(d.chain, q), q, found), SolveStatus::ok);
  EXPECT_NEAR(found[5], 5.5, 1e-10);
}

// The arm straight is a singular posture.
TEST(OpenChain, AtItsReachItIsSolvedAndBeyondUnreachable) {
  const ChainDescription d = offset_wrist_arm();
  const auto machine = make_chain_mechanism(d);
  Axes found{};
  Pose X = forward(d.chain, Axes{});
  EXPECT_EQ(machine->inverse(X, {}, found), SolveStatus::ok);
  expect_pose(*machine, found, X, 1.1e-12);
  // 0.72 m of arm, with the 0.09 m of the fifth axis stretched out too: the tip is at most 0.81 m out.
  X.translation().x() = 0.80;
  EXPECT_EQ(machine->inverse(X, {}, found), SolveStatus::ok);
  expect_pose(*machine, found, X, 1.1e-12);
  X.translation().x() = 0.83;
  EXPECT_EQ(machine->inverse(X, {}, found), SolveStatus::unreachable);
  X.translation().x() = 10;
  EXPECT_EQ(machine->inverse(X, {}, found), SolveStatus::unreachable);
}

TEST(OpenChain, BadInputIsNamedAndLeavesTheAxesAlone) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto machine = make_chain_mechanism(offset_wrist_arm());
  const Pose X_home = machine->home();
  Axes axes;
  axes.fill(0.5);
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity(), 1e200}) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) {
        Pose X = X_home;
        X.matrix()(row, column) = bad;
        const SolveStatus status = machine->inverse(X, {}, axes);
        EXPECT_EQ(status == SolveStatus::bad_input, !(column == 3 && std::isfinite(bad)));
        EXPECT_NE(status, SolveStatus::ok);
      }
    Axes q{};
    q[3] = bad;
    Pose X = X_home;
    Rates rates = Rates::Zero(6, 6);
    if (!std::isfinite(bad)) {
      EXPECT_EQ(machine->inverse(X_home, q, axes), SolveStatus::bad_input);
      EXPECT_EQ(machine->forward(q, X_home, X), SolveStatus::bad_input);
      EXPECT_EQ(machine->axis_rates(X_home, q, rates), SolveStatus::bad_input);
      EXPECT_EQ(machine->condition_number(X_home, q), kSingularCondition);
    }
    EXPECT_TRUE(X.matrix().allFinite());
    EXPECT_TRUE(rates.allFinite());
  }
  for (const double v : axes) EXPECT_EQ(v, 0.5);
}

// Minimum of the weighted norm: any other rates for the same twist are longer. Eight axes leave two free.
TEST(OpenChain, RatesOfRedundantAxesAreTheShortestForTheirTwist) {
  Random random(47, "redundant");
  for (int n = 0; n < 50; ++n) {
    ChainDescription d;
    d.kind = "chain";
    do d.chain = random_chain(random, 8);
    while (d.chain.tool_axis < 0);
    d.home.fill(0.1);
    d.length_scale = 0.3;
    const auto machine = make_chain_mechanism(d);
    const Axes q = random_axes_of(random, 1);
    ChainJacobian J;
    const Pose X = forward(d.chain, q, J);
    Rates rates(8, 6);
    const SolveStatus status = machine->axis_rates(X, q, rates);
    if (status == SolveStatus::singular) continue;  // by chance too few turns
    ASSERT_EQ(status, SolveStatus::ok);
    const double condition = machine->condition_number(X, q);
    EXPECT_LE((J * rates - Mat6::Identity()).cwiseAbs().maxCoeff(), 1e-13 * condition);
    // Shortest: orthogonal, in the metric, to what moves nothing.
    Eigen::VectorXd weight(8);
    for (int i = 0; i < 8; ++i) weight[i] = d.chain.axes[static_cast<std::size_t>(i)].angle ? 0.09 : 1;
    const Eigen::MatrixXd idle = Eigen::FullPivLU<Eigen::MatrixXd>(J).kernel();
    EXPECT_LE(
        (idle.transpose() * weight.asDiagonal() * rates).cwiseAbs().maxCoeff() / (idle.norm() * rates.norm()),
        1e-11);
  }
}

TEST(OpenChain, CallsDoNotAllocate) {
  const ChainDescription d = offset_wrist_arm();
  const auto machine = make_chain_mechanism(d);
  Axes q{}, found{};
  std::copy(d.home.begin(), d.home.end(), q.begin());
  q[2] += 0.1;
  Pose X = forward(d.chain, q);
  Pose far = X, reached = X;
  far.translation().x() += 3;
  Rates rates(6, 6);
  const long before = allocations();
  const SolveStatus solved = machine->inverse(X, {}, found);
  const SolveStatus missed = machine->inverse(far, {}, found);
  const SolveStatus forwards = machine->forward(q, X, reached);
  const SolveStatus rated = machine->axis_rates(X, q, rates);
  const double condition = machine->condition_number(X, q);
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(solved, SolveStatus::ok);
  EXPECT_EQ(missed, SolveStatus::unreachable);
  EXPECT_EQ(forwards, SolveStatus::ok);
  EXPECT_EQ(rated, SolveStatus::ok);
  EXPECT_GT(condition, 1);
}

}  // namespace
}  // namespace understudy::kinematics
