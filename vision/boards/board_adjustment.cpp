#include "vision/boards/board_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "core/cross_matrix.h"

namespace understudy::vision {
namespace {

constexpr int kPlacement = 7;  // offset, rotation, scale
constexpr int kIterations = 12;
// What is said to be exact is held this tightly: below any effect, above rounding of the normal matrix.
constexpr double kExactOffset = 1e-7, kExactRotation = 1e-7, kExactScale = 1e-7, kExactCorner = 0.01;

using Placement = Eigen::Matrix<double, kPlacement, 1>;

BoardPlacement as_placement(const Placement& v) { return {v.head<3>(), v.segment<3>(3), v[6]}; }

Placement prior_weights(const BoardTolerance& t) {
  const auto weight = [](double sigma, double least) { return 1 / std::pow(std::max(sigma, least), 2); };
  Placement w;
  w << Vec3::Constant(weight(t.offset, kExactOffset)), Vec3::Constant(weight(t.rotation, kExactRotation)),
      weight(t.scale, kExactScale);
  return w;
}

/// Misses of one board's corners and their slopes over camera and placement.
struct BoardEquations {
  Eigen::Matrix<double, Eigen::Dynamic, kCameraParameters + kPlacement> J;
  Eigen::VectorXd miss;  // seen minus predicted [px]
};

BoardEquations equations(const Board& board, const Pose& X_FG, const std::vector<Vec2>& seen,
                         const CameraParameters& camera, const Placement& placement) {
  const BoardPlacement where = as_placement(placement);
  std::vector<cv::Point3d> places;
  for (int i = 0; i < board.corners(); ++i) {
    const Vec3 p = X_FG * where.moved(board.corner(i % board.columns, i / board.columns));
    places.emplace_back(p.x(), p.y(), p.z());
  }
  const cv::Mat turn = (cv::Mat_<double>(3, 1) << camera[0], camera[1], camera[2]);
  const cv::Mat shift = (cv::Mat_<double>(3, 1) << camera[3], camera[4], camera[5]);
  const cv::Mat matrix =
      (cv::Mat_<double>(3, 3) << camera[6], 0, camera[7], 0, camera[6], camera[8], 0, 0, 1);
  const cv::Mat brown = (cv::Mat_<double>(5, 1) << camera[9], camera[10], camera[11], camera[12], 0);
  std::vector<cv::Point2d> predicted;
  cv::Mat slopes;  // columns: rvec, tvec, fx, fy, cx, cy, k1, k2, p1, p2, k3
  cv::projectPoints(places, turn, shift, matrix, brown, predicted, slopes);

  const Mat3 R_CG = exp_rotation(camera.head<3>()) * X_FG.linear();
  BoardEquations e;
  e.J.resize(2 * board.corners(), kCameraParameters + kPlacement);
  e.miss.resize(2 * board.corners());
  for (int i = 0; i < board.corners(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 arm = where.moved(board.corner(i % board.columns, i / board.columns)) - where.offset;
    Eigen::Matrix<double, 3, kPlacement> motion;  // of the corner in G over the placement
    motion << Mat3::Identity(), -cross_matrix(arm), arm / (1 + where.scale);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Index row = 2 * i + axis;
      const double* s = slopes.ptr<double>(static_cast<int>(row));
      for (int c = 0; c < 6; ++c) e.J(row, c) = s[c];
      e.J(row, 6) = s[6] + s[7];
      for (int c = 7; c < kCameraParameters; ++c) e.J(row, c) = s[c + 1];
      const Eigen::RowVector3d along(s[3], s[4], s[5]);
      e.J.row(row).tail<kPlacement>() = along * R_CG * motion;
      e.miss[row] = axis == 0 ? seen[k].x() - predicted[k].x : seen[k].y() - predicted[k].y;
    }
  }
  return e;
}

struct NormalEquations {
  Eigen::MatrixXd N;
  Eigen::VectorXd right;
  double squares = 0;  // of the misses [px^2]
};

NormalEquations gather(const CameraLayers& layers, const CalibrationUncertainty& uncertainty,
                       const CameraParameters& camera, const std::vector<Placement>& placements) {
  constexpr Eigen::Index kHead = kCameraParameters;
  const auto boards = static_cast<Eigen::Index>(layers.layers.size());
  const double weight = 1 / std::pow(std::max(uncertainty.corner_px, kExactCorner), 2);
  const Placement prior = prior_weights(uncertainty.boards);
  const Pose X_FW = layers.camera.X_WC.inverse();
  NormalEquations n{Eigen::MatrixXd::Zero(kHead + kPlacement * boards, kHead + kPlacement * boards),
                    Eigen::VectorXd::Zero(kHead + kPlacement * boards)};
  if (uncertainty.principal_px > 0) {
    const double known = 1 / std::pow(uncertainty.principal_px, 2);
    n.N.diagonal().segment<2>(7).array() += known;
    n.right.segment<2>(7) += known * (layers.camera.camera.centre_px - camera.segment<2>(7));
  }
  for (Eigen::Index b = 0; b < boards; ++b) {
    const BoardLayer& layer = layers.layers[static_cast<std::size_t>(b)];
    const Placement& placement = placements[static_cast<std::size_t>(b)];
    const BoardEquations e = equations(layers.board, X_FW * layer.X_WG, layer.corners_px, camera, placement);
    const Eigen::Matrix<double, kHead + kPlacement, kHead + kPlacement> square =
        weight * e.J.transpose() * e.J;
    const Eigen::Matrix<double, kHead + kPlacement, 1> right = weight * e.J.transpose() * e.miss;
    const Eigen::Index at = kHead + kPlacement * b;
    n.N.topLeftCorner<kHead, kHead>() += square.topLeftCorner<kHead, kHead>();
    n.N.block<kHead, kPlacement>(0, at) = square.topRightCorner<kHead, kPlacement>();
    n.N.block<kPlacement, kHead>(at, 0) = square.bottomLeftCorner<kPlacement, kHead>();
    n.N.block<kPlacement, kPlacement>(at, at) = square.bottomRightCorner<kPlacement, kPlacement>();
    n.N.block<kPlacement, kPlacement>(at, at).diagonal() += prior;
    n.right.head<kHead>() += right.head<kHead>();
    n.right.segment<kPlacement>(at) = right.tail<kPlacement>() - prior.cwiseProduct(placement);
    n.squares += e.miss.squaredNorm();
  }
  return n;
}

void step(CameraParameters& camera, std::vector<Placement>& placements, const Eigen::VectorXd& x) {
  camera += x.head<kCameraParameters>();
  for (std::size_t b = 0; b < placements.size(); ++b) {
    placements[b] += x.segment<kPlacement>(kCameraParameters + kPlacement * static_cast<Eigen::Index>(b));
  }
}

}  // namespace

BoardAdjustment adjust_boards(const CameraLayers& layers, const CalibrationUncertainty& uncertainty,
                              const CameraParameters& start) {
  BoardAdjustment result;
  result.camera = start;
  std::vector<Placement> placements(layers.layers.size(), Placement::Zero());
  for (int i = 0; i < kIterations; ++i) {
    const NormalEquations n = gather(layers, uncertainty, result.camera, placements);
    // Unknowns differ by 1e8 in size.
    const Eigen::VectorXd scale = n.N.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::LDLT<Eigen::MatrixXd> solver(scale.asDiagonal() * n.N * scale.asDiagonal());
    const Eigen::VectorXd x = solver.solve(scale.cwiseProduct(n.right));
    step(result.camera, placements, scale.cwiseProduct(x));
    result.residual_px =
        std::sqrt(n.squares / (2.0 * layers.board.corners() * static_cast<double>(layers.layers.size())));
    if (x.norm() > 1e-6 && i + 1 < kIterations) continue;  // in standard deviations
    const Eigen::MatrixXd heads = solver.solve(Eigen::MatrixXd::Identity(n.N.rows(), kCameraParameters));
    const auto s = scale.head<kCameraParameters>().asDiagonal();
    result.covariance = s * heads.topRows<kCameraParameters>() * s;
    break;
  }
  return result;
}

}  // namespace understudy::vision
