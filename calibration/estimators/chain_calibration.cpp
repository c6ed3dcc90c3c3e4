#include "calibration/estimators/chain_calibration.h"

namespace understudy::calibration {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;

constexpr Eigen::Index kMounts = 12;  // parameters of tool and frame

int parameters_of(const ChainAxis& axis) { return axis.angle ? 5 : 3; }

Eigen::Index parameter_count(const Chain& chain) {
  Eigen::Index count = kMounts;
  for (const ChainAxis& axis : chain.axes) count += parameters_of(axis);
  return count;
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

}  // namespace

std::array<Vec3, 2> across(const ChainAxis& axis) {
  const Vec3 u = axis.direction.unitOrthogonal();
  return {u, axis.direction.cross(u)};
}

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

int independent_parameters(const Chain& chain) {
  int count = 6;
  for (const ChainAxis& axis : chain.axes) count += axis.angle ? 4 : 2;
  return count;
}

Eigen::MatrixXd chain_rows(const ChainParameters& machine, const std::vector<double>& readings) {
  const Chain& chain = machine.chain;
  const std::vector<double> q = positions(machine, readings);
  kinematics::PerAxis<Pose> links;
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

  Eigen::MatrixXd rows(6, parameter_count(chain));
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

}  // namespace understudy::calibration
