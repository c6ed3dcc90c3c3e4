#include "calibration/chain_calibration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/calibrated.h"
#include "kinematics/rigid_pose.h"

namespace understudy::calibration {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;

// Relative to the whole column: what is left of a redundant one is rounding, of a poor one 1e-3 and more.
constexpr double kRedundant = 1e-6;
constexpr double kStepDone = 1e-14;  // of step^T H step: 1e-7 standard deviations

int parameters_of(const ChainAxis& axis) { return axis.angle ? 5 : 3; }

/// Two unit vectors across the axis.
std::array<Vec3, 2> across(const ChainAxis& axis) {
  const Vec3 u = axis.direction.unitOrthogonal();
  return {u, axis.direction.cross(u)};
}

bool carried(const Chain& chain, int axis, int last) {
  for (int k = last; k >= 0; k = chain.axes[static_cast<std::size_t>(k)].parent)
    if (k == axis) return true;
  return false;
}

std::vector<double> positions(const ChainParameters& machine, const std::vector<double>& readings) {
  std::vector<double> q = readings;
  for (std::size_t i = 0; i < machine.zero.size(); ++i) q[i] += machine.zero[i];
  return q;
}

/// Motion of the tip, told in O, when the body at X_OL moves by (w, t) about `centre`, all in L.
Twist carried_motion(const Pose& X_OL, const Vec3& w, const Vec3& t, const Vec3& centre, const Vec3& p_OT) {
  Twist motion;
  const Vec3 w_O = X_OL.linear() * w;
  motion << w_O.cross(p_OT - X_OL * centre) + X_OL.linear() * t, w_O;
  return motion;
}

std::string input_fault(const ChainParameters& nominal, const std::vector<ChainSample>& samples) {
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const ChainSample& s = samples[j];
    const std::string pose = "pose " + std::to_string(j + 1) + ": ";
    if (s.axes.size() != nominal.chain.axes.size())
      return pose + std::to_string(s.axes.size()) + " axis readings for " +
             std::to_string(nominal.chain.axes.size()) + " axes";
    if (!std::all_of(s.axes.begin(), s.axes.end(), [](double q) { return std::isfinite(q); }))
      return pose + "an axis reading is not finite";
    if (!kinematics::is_rigid(s.X_ST)) return pose + "the measured pose is not finite and rigid";
    if (!s.covariance.allFinite() || s.covariance.llt().info() != Eigen::Success)
      return pose + "the covariance is not positive definite";
  }
  return {};
}

/// Columns kept, from the first on: one that the kept ones before it explain is redundant.
std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& J) {
  Eigen::MatrixXd basis(J.rows(), 0);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < J.cols(); ++k) {
    const double whole = J.col(k).norm();
    Eigen::VectorXd rest = J.col(k);
    for (int twice = 0; twice < 2; ++twice) rest -= basis * (basis.transpose() * rest);
    if (!(rest.norm() > kRedundant * whole)) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = rest.normalized();
    kept.push_back(k);
  }
  return kept;
}

/// Errors and derivatives of all poses, each whitened by its covariance.
void stack(const ChainParameters& machine, const std::vector<ChainSample>& samples, Eigen::MatrixXd& J,
           Eigen::VectorXd& e) {
  const auto rows = 6 * static_cast<Eigen::Index>(samples.size());
  J.resize(rows, static_cast<Eigen::Index>(chain_parameter_names(machine.chain).size()));
  e.resize(rows);
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const Eigen::LLT<Mat6> root(samples[j].covariance);
    const auto row = 6 * static_cast<Eigen::Index>(j);
    J.middleRows<6>(row) = root.matrixL().solve(chain_rows(machine, samples[j].axes));
    e.segment<6>(row) = root.matrixL().solve(pose_error(samples[j].X_ST, forward(machine, samples[j].axes)));
  }
}

}  // namespace

Pose forward(const ChainParameters& machine, const std::vector<double>& readings) {
  return kinematics::forward(machine.chain, positions(machine, readings));
}

std::vector<std::string> chain_parameter_names(const Chain& chain) {
  std::vector<std::string> names;
  for (const ChainAxis& axis : chain.axes) {
    for (const char* what : {" zero", " tilt u", " tilt v"}) names.push_back(axis.name + what);
    if (!axis.angle) continue;
    for (const char* what : {" shift u", " shift v"}) names.push_back(axis.name + what);
  }
  for (const char* body : {"tool ", "frame "})
    for (const char* what : {"x", "y", "z", "turn x", "turn y", "turn z"})
      names.push_back(std::string(body) + what);
  return names;
}

Eigen::MatrixXd chain_rows(const ChainParameters& machine, const std::vector<double>& readings) {
  const Chain& chain = machine.chain;
  const std::vector<double> q = positions(machine, readings);
  std::array<Pose, kinematics::kMaxAxes> links;
  kinematics::link_poses(chain, q, links);
  const auto link = [&](int axis) {
    return axis < 0 ? Pose::Identity() : links[static_cast<std::size_t>(axis)];
  };
  const Pose X_OS = link(chain.work_axis) * chain.X_OS_zero;
  const Vec3 p_OT = link(chain.tool_axis) * chain.X_OT_zero.translation();
  kinematics::ChainJacobian by_axes;
  const Pose X_ST = kinematics::forward(chain, q, by_axes);
  Mat6 to_S = Mat6::Zero();
  to_S.topLeftCorner<3, 3>() = to_S.bottomRightCorner<3, 3>() = X_OS.linear().transpose();

  Eigen::MatrixXd rows(6, static_cast<Eigen::Index>(chain_parameter_names(chain).size()));
  Eigen::Index column = 0;
  for (int i = 0; i < chain.size(); ++i) {
    const ChainAxis& axis = chain.axes[static_cast<std::size_t>(i)];
    // An axis that carries both moves neither against the other.
    const double sign =
        (carried(chain, i, chain.tool_axis) ? 1.0 : 0.0) - (carried(chain, i, chain.work_axis) ? 1.0 : 0.0);
    const auto [u, v] = across(axis);
    const Pose before = link(axis.parent), after = link(i);
    // exp(d) exp(screw q) exp(-d): the line moves with its carrier, and what it carries moves back.
    const auto moved_line = [&](const Vec3& w, const Vec3& t) {
      return Twist(
          sign * to_S *
          (carried_motion(before, w, t, axis.point, p_OT) - carried_motion(after, w, t, axis.point, p_OT)));
    };
    rows.col(column) = by_axes.col(i);
    rows.col(column + 1) = moved_line(u, Vec3::Zero());
    rows.col(column + 2) = moved_line(v, Vec3::Zero());
    if (axis.angle) {
      rows.col(column + 3) = moved_line(Vec3::Zero(), u);
      rows.col(column + 4) = moved_line(Vec3::Zero(), v);
    }
    column += parameters_of(axis);
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vec3 unit = Vec3::Unit(k);
    rows.col(column + k) << X_ST.linear() * unit, Vec3::Zero();
    rows.col(column + 3 + k) << Vec3::Zero(), X_ST.linear() * unit;
    rows.col(column + 6 + k) << -unit, Vec3::Zero();
    rows.col(column + 9 + k) << -unit.cross(X_ST.translation()), -unit;
  }
  return rows;
}

ChainParameters moved(const ChainParameters& from, const Eigen::VectorXd& by) {
  ChainParameters to = from;
  to.zero.resize(from.chain.axes.size(), 0.0);
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < to.chain.axes.size(); ++i) {
    ChainAxis& axis = to.chain.axes[i];
    const auto [u, v] = across(axis);
    to.zero[i] += by[column];
    axis.direction = (exp_rotation(by[column + 1] * u + by[column + 2] * v) * axis.direction).normalized();
    if (axis.angle) axis.point += by[column + 3] * u + by[column + 4] * v;
    column += parameters_of(axis);
  }
  const auto mount = [&by](const Pose& X, Eigen::Index first) {
    return make_pose(Mat3(X.linear() * exp_rotation(by.segment<3>(first + 3))),
                     X * Vec3(by.segment<3>(first)));
  };
  to.chain.X_OT_zero = mount(from.chain.X_OT_zero, column);
  to.chain.X_OS_zero = mount(from.chain.X_OS_zero, column + 6);
  return to;
}

ChainCalibration calibrate_chain(const ChainParameters& nominal, const std::vector<ChainSample>& samples,
                                 int max_iterations) {
  ChainCalibration result;
  result.parameters = nominal;
  result.message = input_fault(nominal, samples);
  result.status = result.message.empty() ? Status::not_converged : Status::bad_input;
  if (result.status == Status::bad_input) return result;

  Eigen::MatrixXd J;
  Eigen::VectorXd e;
  stack(nominal, samples, J, e);
  const std::vector<Eigen::Index> kept = independent_columns(J);
  const std::vector<std::string> names = chain_parameter_names(nominal.chain);
  for (std::size_t k = 0; k < names.size(); ++k)
    (std::binary_search(kept.begin(), kept.end(), static_cast<Eigen::Index>(k)) ? result.estimated
                                                                                : result.redundant)
        .push_back(names[k]);
  int possible = 6;
  for (const ChainAxis& axis : nominal.chain.axes) possible += axis.angle ? 4 : 2;
  if (static_cast<int>(kept.size()) < possible) {
    const bool few = 6 * static_cast<int>(samples.size()) < possible;
    result.status = few ? Status::too_few_poses : Status::rank_deficient;
    result.message = std::to_string(samples.size()) + " poses tell " + std::to_string(kept.size()) + " of " +
                     std::to_string(possible) + " independent parameters: move every axis, in at least " +
                     std::to_string((possible + 5) / 6) + " poses that differ";
    return result;
  }

  Eigen::LLT<Eigen::MatrixXd> factors;
  double curvature = 1;
  for (; result.iterations < max_iterations && curvature > kStepDone; ++result.iterations) {
    const Eigen::MatrixXd A = J(Eigen::all, kept);
    factors.compute(A.transpose() * A);
    const Eigen::VectorXd step = factors.solve(A.transpose() * e);
    curvature = (A * step).squaredNorm();
    if (factors.info() != Eigen::Success || !std::isfinite(curvature)) break;
    Eigen::VectorXd by = Eigen::VectorXd::Zero(J.cols());
    for (std::size_t k = 0; k < kept.size(); ++k) by[kept[k]] = step[static_cast<Eigen::Index>(k)];
    result.parameters = moved(result.parameters, by);
    stack(result.parameters, samples, J, e);
  }
  result.chi_square = e.squaredNorm();
  result.degrees_of_freedom = static_cast<int>(e.size()) - static_cast<int>(kept.size());
  for (const ChainSample& s : samples)
    result.residuals.push_back(pose_error(s.X_ST, forward(result.parameters, s.axes)));
  if (curvature > kStepDone || !std::isfinite(result.chi_square)) {
    result.message = "the search did not settle after " + std::to_string(result.iterations) +
                     " iterations: are readings and poses of the same rows, and the machine the right one?";
    return result;
  }
  result.covariance = factors.solve(Eigen::MatrixXd::Identity(factors.rows(), factors.rows()));
  result.status = Status::ok;
  return result;
}

}  // namespace understudy::calibration
