#include "calibration/bundle/bundle_equations.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "calibration/bundle/session_time.h"
#include "calibration/strut_model.h"
#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// What is said to be exact is held this tightly: below any effect, above rounding of the normal matrix.
constexpr double kExactLength = 1e-7, kExactShare = 1e-7, kExactCorner = 0.01;  // [m], 1 or [rad], [px]

double weight(double sigma, double least) { return 1 / std::max(sigma, least); }

std::vector<Index> range(Index first, Index count) {
  std::vector<Index> columns;
  for (Index k = 0; k < count; ++k) columns.push_back(first + k);
  return columns;
}

std::vector<Index> joined(std::vector<Index> a, const std::vector<Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Where a corner is in G, and its slopes over placement (offset, rotation, scale) and print (scale, bow).
struct PlacedCorner {
  PlacedCorner(const vision::Board& board, const vision::BoardPlacement& where,
               const vision::PrintError& print, const Vec3& drawn) {
    const Mat3 R = exp_rotation(where.rotation);
    const Vec3 printed = print.printed(board, drawn), arm = (1 + where.scale) * (R * printed);
    const Vec2 at = drawn.head<2>().cwiseQuotient(board.half_size());
    place = arm + where.offset;
    // The left Jacobian of a turn of some mrad: its next term is a millionth.
    by_placement << Mat3::Identity(),
        -cross_matrix(arm) * (Mat3::Identity() + 0.5 * cross_matrix(where.rotation)), R * printed;
    const Vec3 up = (1 + where.scale) * R.col(2);
    by_print << (1 + where.scale) * (R * drawn), at.x() * at.x() * up, at.x() * at.y() * up,
        at.y() * at.y() * up;
  }
  Vec3 place;
  Eigen::Matrix<double, 3, BundleLayout::kPlacement> by_placement;
  Eigen::Matrix<double, 3, BundleLayout::kPrint> by_print;
};

/// One board's corners; residuals are predicted less seen.
bool add_board(const BundleProblem& problem, const BundleState& state, const BundleLayout& layout,
               std::size_t b, ArrowEquations& equations) {
  const vision::SeenBoard& seen = problem.boards[b];
  const vision::Board& board = problem.rig.board;
  const auto camera = static_cast<std::size_t>(seen.camera);
  const Pose X_WG = problem.rig.X_WG(seen.camera, seen.layer);
  const double w = weight(problem.uncertainty.corner_px, kExactCorner);
  const Index rows = 2 * static_cast<Index>(seen.corners_px.size());
  VectorXd residual(rows);
  MatrixXd by_shared(rows, vision::kCameraNumbers + BundleLayout::kPrint);
  MatrixXd by_local(rows, BundleLayout::kPlacement);
  vision::PixelSlopes at;
  for (int i = 0; i < board.corners(); ++i) {
    const PlacedCorner corner(board, state.boards[b], state.prints[camera],
                              board.corner(i % board.columns, i / board.columns));
    if (!vision::pixel_slopes(state.cameras[camera], X_WG * corner.place, at)) return false;
    const Eigen::Matrix<double, 2, 3> by_G = at.by_point * X_WG.linear();
    const Index row = Index{2} * i;
    residual.segment<2>(row) = w * (at.pixel - seen.corners_px[static_cast<std::size_t>(i)]);
    by_shared.middleRows<2>(row).leftCols<vision::kCameraNumbers>() = w * at.by_camera;
    by_shared.middleRows<2>(row).rightCols<BundleLayout::kPrint>() = w * by_G * corner.by_print;
    by_local.middleRows<2>(row) = w * by_G * corner.by_placement;
  }
  equations.add(residual,
                joined(range(layout.camera(seen.camera), vision::kCameraNumbers),
                       range(layout.print(seen.camera), BundleLayout::kPrint)),
                by_shared, b, by_local);
  return true;
}

/// The three targets in one picture.
bool add_targets(const BundleProblem& problem, const BundleState& state, const BundleLayout& layout,
                 std::size_t j, int camera, ArrowEquations& equations) {
  const auto c = static_cast<std::size_t>(camera);
  const Pose X_WT = problem.X_WB * state.poses[j];
  VectorXd residual(6);
  MatrixXd by_shared(6, vision::kCameraNumbers), by_local(6, BundleLayout::kPose);
  vision::PixelSlopes at;
  for (std::size_t k = 0; k < problem.rig.targets.size(); ++k) {
    const Vec3& p_T = problem.rig.targets[k];
    if (!vision::pixel_slopes(state.cameras[c], X_WT * p_T, at)) return false;
    const vision::PixelPoint& seen = problem.poses[j].targets[c][k];
    const Eigen::LLT<Eigen::Matrix2d> root(seen.covariance);
    Eigen::Matrix<double, 3, BundleLayout::kPose> motion;
    motion << Mat3::Identity(), -cross_matrix(state.poses[j].linear() * p_T);
    const Index row = 2 * static_cast<Index>(k);
    const auto whitened = [&](const auto& of) { return root.matrixL().solve(of).eval(); };
    residual.segment<2>(row) = whitened(Vec2(at.pixel - seen.pixel));
    by_shared.middleRows<2>(row) = whitened(at.by_camera);
    by_local.middleRows<2>(row) =
        whitened(Eigen::Matrix<double, 2, 6>(at.by_point * problem.X_WB.linear() * motion));
  }
  equations.add(residual, range(layout.camera(camera), vision::kCameraNumbers), by_shared, layout.boards + j,
                by_local);
  return true;
}

bool add_struts(const BundleProblem& problem, const BundleState& state, const BundleLayout& layout,
                std::size_t j, ArrowEquations& equations) {
  const BundlePose& pose = problem.poses[j];
  StrutLinearisation at;
  if (!linearise(state.machine, strut_sample(problem, state, j), state.poses[j], at)) return false;
  const Index machine = layout.machine();
  MatrixXd by_shared = MatrixXd::Zero(6, layout.count() - machine);
  by_shared.leftCols(layout.unknowns.count()) = dense_rows(at, layout.unknowns);
  VectorXd w(6);
  for (Index i = 0; i < kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const bool unknown = pose.approach[s] == Approach::unknown;
    w[i] = weight(std::hypot(problem.drives.length, unknown ? problem.drives.side_unknown : 0), kExactLength);
    if (layout.leads) by_shared(i, layout.lead() - machine + i) = -pose.displacement[s];
    if (layout.warms)
      by_shared.row(i).segment<kWarmingTerms>(layout.warming() - machine) = time_left(problem, j).transpose();
  }
  equations.add(w.cwiseProduct(at.residual), range(machine, by_shared.cols()), w.asDiagonal() * by_shared,
                layout.boards + j, w.asDiagonal() * at.by_pose);
  return true;
}

void add_board_priors(const BundleProblem& problem, const BundleState& state, const BundleLayout& layout,
                      ArrowEquations& equations) {
  const vision::BoardTolerance& t = problem.uncertainty.boards;
  for (std::size_t b = 0; b < layout.boards; ++b) {
    const vision::BoardPlacement& at = state.boards[b];
    for (Index k = 0; k < 3; ++k) {
      equations.add_local_prior(b, k, at.offset[k], weight(t.offset, kExactLength));
      equations.add_local_prior(b, 3 + k, at.rotation[k], weight(t.rotation, kExactShare));
    }
    equations.add_local_prior(b, 6, at.scale, weight(t.scale, kExactShare));
  }
  for (int c = 0; c < 2; ++c) {
    const vision::PrintError& print = state.prints[static_cast<std::size_t>(c)];
    equations.add_prior(layout.print(c), print.scale, weight(t.print_scale, kExactShare));
    for (Index k = 0; k < 3; ++k)
      equations.add_prior(layout.print(c) + 1 + k, print.bow[k], weight(t.flatness, kExactLength));
  }
}

void add_camera_and_drive_priors(const BundleProblem& problem, const BundleState& state,
                                 const BundleLayout& layout, ArrowEquations& equations) {
  constexpr Index kCentre = 7;
  if (const double sigma = problem.uncertainty.principal_px; sigma > 0)
    for (int c = 0; c < 2; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const Vec2 off = state.cameras[k].camera.centre_px - problem.rig.cameras[k].camera.centre_px;
      for (Index i = 0; i < 2; ++i) equations.add_prior(layout.camera(c) + kCentre + i, off[i], 1 / sigma);
    }
  for (std::size_t i = 0; i < kStruts; ++i) {
    const auto at = static_cast<Index>(i);
    if (layout.leads) equations.add_prior(layout.lead() + at, state.lead[i], 1 / problem.drives.lead);
    if (layout.unknowns.play && problem.drives.play > 0)
      equations.add_prior(layout.machine() + layout.unknowns.first_play() + at,
                          state.machine.play[i] - problem.nominal.play[i], 1 / problem.drives.play);
  }
  for (Index k = 0; layout.warms && k < kWarmingTerms; ++k)
    equations.add_prior(layout.warming() + k, state.warming[k], 1 / problem.drives.warming);
}

}  // namespace

BundleLayout::BundleLayout(const BundleProblem& problem)
    : unknowns(problem.unknowns),
      leads(problem.leads_unknown()),
      warms(problem.warms()),
      boards(problem.boards.size()),
      poses(problem.poses.size()) {}

std::vector<Index> BundleLayout::block_sizes() const {
  std::vector<Index> sizes(boards, kPlacement);
  sizes.insert(sizes.end(), poses, kPose);
  return sizes;
}

bool gather(const BundleProblem& problem, const BundleState& state, ArrowEquations& equations) {
  const BundleLayout layout(problem);
  for (std::size_t b = 0; b < layout.boards; ++b)
    if (!add_board(problem, state, layout, b, equations)) return false;
  for (std::size_t j = 0; j < layout.poses; ++j) {
    for (int camera = 0; camera < 2; ++camera)
      if (!add_targets(problem, state, layout, j, camera, equations)) return false;
    if (!add_struts(problem, state, layout, j, equations)) return false;
  }
  add_board_priors(problem, state, layout, equations);
  add_camera_and_drive_priors(problem, state, layout, equations);
  return std::isfinite(equations.cost());
}

BundleState moved(const BundleProblem& problem, const BundleState& from, const ArrowEquations::Step& by) {
  const BundleLayout layout(problem);
  BundleState to = from;
  for (int c = 0; c < 2; ++c) {
    const auto k = static_cast<std::size_t>(c);
    to.cameras[k] =
        vision::moved(from.cameras[k], by.shared.segment<vision::kCameraNumbers>(layout.camera(c)));
    to.prints[k].scale += by.shared[layout.print(c)];
    to.prints[k].bow += by.shared.segment<3>(layout.print(c) + 1);
  }
  to.machine =
      moved(from.machine, by.shared.segment(layout.machine(), layout.unknowns.count()), layout.unknowns);
  for (std::size_t i = 0; layout.leads && i < kStruts; ++i)
    to.lead[i] += by.shared[layout.lead() + static_cast<Index>(i)];
  if (layout.warms) to.warming += by.shared.segment<kWarmingTerms>(layout.warming());
  for (std::size_t b = 0; b < layout.boards; ++b) {
    to.boards[b].offset += by.local[b].head<3>();
    to.boards[b].rotation += by.local[b].segment<3>(3);
    to.boards[b].scale += by.local[b][6];
  }
  for (std::size_t j = 0; j < layout.poses; ++j) {
    const VectorXd& step = by.local[layout.boards + j];
    to.poses[j] = make_pose(Mat3(exp_rotation(step.tail<3>()) * from.poses[j].linear()),
                            Vec3(from.poses[j].translation() + step.head<3>()));
  }
  return to;
}

}  // namespace understudy::calibration
