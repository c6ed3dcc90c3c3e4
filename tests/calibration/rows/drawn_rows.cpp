#include "tests/calibration/rows/drawn_rows.h"

#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "calibration/pose_choice.h"
#include "calibration/rows/free_parameters.h"

namespace understudy::calibration {

DrawnRows::DrawnRows(const std::vector<Eigen::Index>& columns, std::uint64_t seed, const std::string& name)
    : random(seed, "drawn rows"), description(machine::load_machine(name)) {
  nominal = nominal_rows(description);
  const auto parameters = nominal.parameters();
  Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
  for (const Eigen::Index k : columns)
    by[k] = (parameters[static_cast<std::size_t>(k)].angle ? 0.5e-3 : 0.3e-3) * random.normal();
  built = nominal.moved(by);
  problem.nominal = nominal;
  X_MS = make_pose(exp_rotation({0.3, -1.1, 2.0}), {2.6, -1.1, 0.2});
}

RowMachine DrawnRows::nominal_rows(const machine::MachineDescription& machine) {
  if (machine.is_chain()) return ChainParameters{machine.chain().kinematics.chain, {}};
  const HexapodGeometry& geometry = machine.hexapod().geometry;
  return RowHexapod{geometry, geometry.length_offset, machine.X_BT_home};
}

std::vector<double> DrawnRows::drawn_axes() {
  std::vector<double> axes;
  if (!nominal.chain()) {
    const auto mechanism = description.make_mechanism();
    const Pose X = random_reachable_poses(*mechanism, reference_region(description.X_BT_home), 1, random)[0];
    StrutLengths lengths{};
    (void)kinematics::inverse(nominal.hexapod()->geometry, X, lengths);
    return {lengths.begin(), lengths.end()};
  }
  for (const auto& axis : nominal.chain()->chain.axes)
    axes.push_back(
        random.uniform(std::max(axis.lower, -std::numbers::pi), std::min(axis.upper, std::numbers::pi)));
  return axes;
}

Vec3 DrawnRows::noise(double sigma) {
  return sigma * Vec3(random.normal(), random.normal(), random.normal());
}

MeasurementRow DrawnRows::row(RowKind kind) {
  MeasurementRow out;
  out.kind = kind;
  out.axes = drawn_axes();
  out.noise_told = true;
  out.covariance.diagonal().head<3>().setConstant(kDrawnSigma * kDrawnSigma);
  out.covariance.diagonal().tail<3>().setConstant(kDrawnTurn * kDrawnTurn);
  return out;
}

void DrawnRows::add_in_frame(RowKind kind, const std::string& name, const Pose& X_TG, int count) {
  for (int j = 0; j < count; ++j) {
    MeasurementRow out = row(kind);
    out.frame = "tracker";
    out.target = name;
    const Pose X = X_MS * built.forward(out.axes) * X_TG;
    out.X_MG =
        make_pose(Mat3(exp_rotation(noise(kDrawnTurn)) * X.linear()), X.translation() + noise(kDrawnSigma));
    problem.rows.push_back(out);
  }
}

void DrawnRows::add_three_targets(double shared, int count) {
  const Vec3 targets[] = {{-0.05, 0.02, 0.03}, {0.03, -0.04, 0.06}, {0.02, 0.05, -0.01}};
  for (int j = 0; j < count; ++j) {
    MeasurementRow out = row(RowKind::position);
    out.frame = "tracker";
    const Vec3 common = noise(shared);
    for (std::size_t i = 0; i < 3; ++i) {
      out.target = std::string("r") + "123"[i];
      out.X_MG.translation() = X_MS * (built.forward(out.axes) * targets[i]) + common + noise(kDrawnSigma);
      problem.rows.push_back(out);
    }
  }
}

double DrawnRows::error_squared(const RowCalibration& found, const std::vector<Eigen::Index>& columns) {
  // Whole poses of found and built machine differ by what the parameters differ: no frame is between them.
  const auto free = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd J(240, free);
  Eigen::VectorXd apart(240);
  for (Eigen::Index j = 0; j < 40; ++j) {
    const auto axes = drawn_axes();
    const Pose X = built.forward(axes), Y = found.machine.forward(axes);
    J.middleRows<6>(6 * j) = built.parameter_rows(axes, X)(Eigen::all, columns);
    apart.segment<6>(6 * j) << Y.translation() - X.translation(),
        log_rotation(Y.linear() * X.linear().transpose());
  }
  const Eigen::VectorXd error = J.colPivHouseholderQr().solve(apart);
  return error.dot(found.covariance.ldlt().solve(error)) / static_cast<double>(free);
}

void DrawnRows::add_distances(const std::string& anchor, const Vec3& p, double zero, const Vec3& p_TG,
                              int count) {
  for (int j = 0; j < count; ++j) {
    MeasurementRow out = row(RowKind::distance);
    out.target = "ball";
    out.place = anchor;
    out.distance = (built.forward(out.axes) * p_TG - p).norm() + zero + kDrawnSigma * random.normal();
    problem.rows.push_back(out);
  }
}

bool DrawnRows::within_struts(const std::vector<double>& lengths) const {
  if (nominal.chain()) return true;
  const auto& limits = description.hexapod().limits;
  return nominal.forward(lengths).matrix().allFinite() &&
         std::all_of(lengths.begin(), lengths.end(),
                     [&](double length) { return length >= limits.strut_min && length <= limits.strut_max; });
}

std::vector<double> DrawnRows::axes_where(const Vec3& p_TG,
                                          const std::function<Eigen::VectorXd(const Vec3&)>& wanted) {
  while (true) {
    std::vector<double> q = drawn_axes();
    for (int step = 0; step < 60; ++step) {
      const auto value = [&](const std::vector<double>& at) { return wanted(built.forward(at) * p_TG); };
      const Eigen::VectorXd f = value(q);
      if (f.norm() < 1e-11 && within_struts(q)) return q;
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

void DrawnRows::add_points(const std::string& name, const Vec3& p, const Vec3& p_TG, int count) {
  for (int j = 0; j < count; ++j) {
    MeasurementRow out = row(RowKind::point);
    out.target = "ball";
    out.place = name;
    const Vec3 reached = p + noise(kDrawnSigma);
    out.axes = axes_where(p_TG, [&](const Vec3& at) -> Eigen::VectorXd { return at - reached; });
    problem.rows.push_back(out);
  }
}

void DrawnRows::add_plane(const std::string& name, const Vec3& normal, double offset, const Vec3& p_TG,
                          int count) {
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

}  // namespace understudy::calibration
