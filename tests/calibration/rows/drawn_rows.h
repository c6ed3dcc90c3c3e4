// Rows of measurements of a machine built beside its drawing, drawn with noise.
#pragma once

#include <functional>
#include <numbers>

#include <Eigen/QR>

#include "calibration/rows/calibrate_rows.h"
#include "calibration/rows/free_parameters.h"
#include "core/random.h"
#include "machine/description.h"

namespace understudy::calibration {

constexpr double kDrawnSigma = 50e-6;  // [m]
constexpr double kDrawnTurn = 0.2e-3;  // [rad]

/// A built arm: its parameters of `columns` are off by 0.3 mm and 0.5 mrad, 1 sigma each.
class DrawnRows {
 public:
  DrawnRows(const std::vector<Eigen::Index>& columns, std::uint64_t seed) : random(seed, "drawn rows") {
    nominal.chain = machine::load_machine("arm").chain().kinematics.chain;
    const auto names = chain_parameter_names(nominal.chain);
    Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
    for (const Eigen::Index k : columns)
      by[k] =
          (is_angle(names[static_cast<std::size_t>(k)], nominal.chain) ? 0.5e-3 : 0.3e-3) * random.normal();
    built = moved(nominal, by);
    problem.nominal = nominal;
    X_MS = make_pose(exp_rotation({0.3, -1.1, 2.0}), {2.6, -1.1, 0.2});
  }

  std::vector<double> drawn_axes() {
    std::vector<double> axes;
    for (const auto& axis : nominal.chain.axes)
      axes.push_back(
          random.uniform(std::max(axis.lower, -std::numbers::pi), std::min(axis.upper, std::numbers::pi)));
    return axes;
  }

  Vec3 noise(double sigma) { return sigma * Vec3(random.normal(), random.normal(), random.normal()); }

  MeasurementRow row(RowKind kind) {
    MeasurementRow out;
    out.kind = kind;
    out.axes = drawn_axes();
    out.noise_told = true;
    out.covariance.diagonal().head<3>().setConstant(kDrawnSigma * kDrawnSigma);
    out.covariance.diagonal().tail<3>().setConstant(kDrawnTurn * kDrawnTurn);
    return out;
  }

  /// Of target `name` at X_TG, seen from the frame.
  void add_in_frame(RowKind kind, const std::string& name, const Pose& X_TG, int count) {
    for (int j = 0; j < count; ++j) {
      MeasurementRow out = row(kind);
      out.frame = "tracker";
      out.target = name;
      const Pose X = X_MS * forward(built, out.axes) * X_TG;
      out.X_MG =
          make_pose(Mat3(exp_rotation(noise(kDrawnTurn)) * X.linear()), X.translation() + noise(kDrawnSigma));
      problem.rows.push_back(out);
    }
  }

  void add_distances(const std::string& anchor, const Vec3& p, double zero, const Vec3& p_TG, int count) {
    for (int j = 0; j < count; ++j) {
      MeasurementRow out = row(RowKind::distance);
      out.target = "ball";
      out.place = anchor;
      out.distance = (forward(built, out.axes) * p_TG - p).norm() + zero + kDrawnSigma * random.normal();
      problem.rows.push_back(out);
    }
  }

  /// Axes that put `p_TG` where `wanted` is zero: Newton steps of least norm from drawn axes.
  std::vector<double> axes_where(const Vec3& p_TG,
                                 const std::function<Eigen::VectorXd(const Vec3&)>& wanted) {
    while (true) {
      std::vector<double> q = drawn_axes();
      for (int step = 0; step < 60; ++step) {
        const auto value = [&](const std::vector<double>& at) { return wanted(forward(built, at) * p_TG); };
        const Eigen::VectorXd f = value(q);
        if (f.norm() < 1e-11) return q;
        Eigen::MatrixXd J(f.size(), static_cast<Eigen::Index>(q.size()));
        for (std::size_t i = 0; i < q.size(); ++i) {
          std::vector<double> by = q;
          by[i] += 1e-6;
          J.col(static_cast<Eigen::Index>(i)) = (value(by) - f) / 1e-6;
        }
        Eigen::VectorXd d = J.completeOrthogonalDecomposition().solve(f);
        if (d.norm() > 0.3) d *= 0.3 / d.norm();
        for (std::size_t i = 0; i < q.size(); ++i) q[i] -= d[static_cast<Eigen::Index>(i)];
      }
    }
  }

  void add_points(const std::string& name, const Vec3& p, const Vec3& p_TG, int count) {
    for (int j = 0; j < count; ++j) {
      MeasurementRow out = row(RowKind::point);
      out.target = "ball";
      out.place = name;
      const Vec3 reached = p + noise(kDrawnSigma);
      out.axes = axes_where(p_TG, [&](const Vec3& at) -> Eigen::VectorXd { return at - reached; });
      problem.rows.push_back(out);
    }
  }

  void add_plane(const std::string& name, const Vec3& normal, double offset, const Vec3& p_TG, int count) {
    for (int j = 0; j < count; ++j) {
      MeasurementRow out = row(RowKind::plane);
      out.target = "ball";
      out.place = name;
      const double reached = offset + kDrawnSigma * random.normal();
      out.axes = axes_where(p_TG, [&](const Vec3& at) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, normal.dot(at) - reached);
      });
      problem.rows.push_back(out);
    }
  }

  Random random;
  ChainParameters nominal, built;
  Pose X_MS;
  RowProblem problem;
};

}  // namespace understudy::calibration
