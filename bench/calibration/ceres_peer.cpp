#include "bench/calibration/ceres_peer.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>

namespace understudy::bench {
namespace {

using calibration::kStrutParameters;
using kinematics::HexapodGeometry;
using kinematics::kStruts;
using Blocks = std::array<std::array<double, kStrutParameters>, kStruts>;

HexapodGeometry geometry_of(const double* const* blocks, double deviation) {
  HexapodGeometry g;
  g.deviation = deviation;
  for (std::size_t i = 0; i < kStruts; ++i) {
    g.base_joint[i] = Eigen::Map<const Vec3>(blocks[i]);
    g.platform_joint[i] = Eigen::Map<const Vec3>(blocks[i] + 3);
    g.length_offset[i] = blocks[i][6];
  }
  return g;
}

template <class T>
const double& plain(const T& value) {
  if constexpr (std::is_same_v<T, double>)
    return value;
  else
    return value.a;
}

class PoseError {
 public:
  PoseError(const calibration::PoseSample& sample, double deviation)
      : sample_(sample), deviation_(deviation), seed_(sample.X_BT) {
    const Mat6 weight = sample.covariance.llt().solve(Mat6::Identity());
    root_ = weight.llt().matrixU();
  }

  template <class T>
  bool operator()(const T* s0, const T* s1, const T* s2, const T* s3, const T* s4, const T* s5,
                  T* out) const {
    const T* blocks[kStruts] = {s0, s1, s2, s3, s4, s5};
    std::array<std::array<double, kStrutParameters>, kStruts> values;
    const double* pointers[kStruts];
    for (std::size_t i = 0; i < kStruts; ++i) {
      for (std::size_t k = 0; k < kStrutParameters; ++k) values[i][k] = plain(blocks[i][k]);
      pointers[i] = values[i].data();
    }
    const HexapodGeometry g = geometry_of(pointers, deviation_);
    kinematics::StrutLengths lengths;
    for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = g.length_offset[i] + sample_.displacement[i];
    const auto forward = kinematics::forward(g, lengths, seed_);
    Mat6 J;
    if (forward.status != kinematics::SolveStatus::ok ||
        jacobian(g, forward.X_BT, J) != kinematics::SolveStatus::ok)
      return false;
    seed_ = forward.X_BT;
    write_error(blocks, forward.X_BT, Mat6(J.inverse()), out);
    return true;
  }

 private:
  template <class T>
  void write_error(const T* const* blocks, const Pose& X_BT, const Mat6& inverse, T* out) const {
    using Vec3T = Eigen::Matrix<T, 3, 1>;
    Eigen::Matrix<T, 6, 1> residual;
    for (int i = 0; i < kStruts; ++i) {
      const Eigen::Map<const Vec3T> b(blocks[i]), a(blocks[i] + 3);
      const Vec3T d = b - X_BT.translation().cast<T>() - X_BT.linear().cast<T>() * a;
      residual[i] = sqrt(d.squaredNorm() - T(deviation_ * deviation_)) - blocks[i][6] -
                    T(sample_.displacement[static_cast<std::size_t>(i)]);
    }
    const Eigen::Matrix<T, 6, 1> step = -(inverse.cast<T>() * residual);
    // The step is 0 but for its derivatives, so turning by it to first order is exact.
    const Mat3 off = sample_.X_BT.linear() * X_BT.linear().transpose();
    Eigen::Matrix<T, 3, 3> turn = Eigen::Matrix<T, 3, 3>::Identity();
    turn(0, 1) = step[5], turn(0, 2) = -step[4], turn(1, 2) = step[3];
    turn(1, 0) = -step[5], turn(2, 0) = step[4], turn(2, 1) = -step[3];
    const Eigen::Matrix<T, 3, 3> left = off.cast<T>() * turn;
    Eigen::Matrix<T, 6, 1> e;
    e.template head<3>() =
        (sample_.X_BT.translation() - X_BT.translation()).template cast<T>() - step.template head<3>();
    Vec3T w;
    ceres::RotationMatrixToAngleAxis(left.data(), w.data());
    e.template tail<3>() = w;
    Eigen::Map<Eigen::Matrix<T, 6, 1>> result(out);
    result = root_.cast<T>() * e;
  }

  const calibration::PoseSample& sample_;
  double deviation_;
  Mat6 root_;
  mutable Pose seed_;
};

}  // namespace

CeresAnswer solve_with_ceres(const calibration::Problem& problem, bool normal_equations) {
  Blocks blocks;
  const HexapodGeometry& g = problem.nominal.geometry;
  for (std::size_t i = 0; i < kStruts; ++i)
    blocks[i] = {g.base_joint[i].x(),     g.base_joint[i].y(),     g.base_joint[i].z(),
                 g.platform_joint[i].x(), g.platform_joint[i].y(), g.platform_joint[i].z(),
                 g.length_offset[i]};
  ceres::Problem peer;
  for (const calibration::PoseSample& sample : problem.samples)
    peer.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PoseError, 6, 7, 7, 7, 7, 7, 7>(new PoseError(sample, g.deviation)),
        nullptr, blocks[0].data(), blocks[1].data(), blocks[2].data(), blocks[3].data(), blocks[4].data(),
        blocks[5].data());
  ceres::Solver::Options options;
  options.linear_solver_type = normal_equations ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  // Levenberg's damping as good as off from the start: Gauss-Newton, the fastest it can be here.
  options.initial_trust_region_radius = 1e16;
  options.max_trust_region_radius = 1e32;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-30;
  options.parameter_tolerance = 1e-10;  // of the parameters' norm, 0.5 m: steps of 0.05 nm
  ceres::Solver::Summary summary;
  ceres::Solve(options, &peer, &summary);
  const double* pointers[kStruts];
  for (std::size_t i = 0; i < kStruts; ++i) pointers[i] = blocks[i].data();
  return {summary.IsSolutionUsable(), geometry_of(pointers, g.deviation),
          static_cast<int>(summary.iterations.size()) - 1, 2 * summary.final_cost};
}

}  // namespace understudy::bench
