#include "calibration/rows/surroundings_start.h"

#include <Eigen/Eigenvalues>

#include "core/decompositions.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Slot = SurroundingsLayout::Slot;

bool has_turn(RowKind kind) { return kind == RowKind::pose || kind == RowKind::orientation; }
bool in_frame(RowKind kind) { return has_turn(kind) || kind == RowKind::position; }

class Starter {
 public:
  Starter(const RowProblem& problem, const SurroundingsLayout& layout)
      : problem_(problem), layout_(layout), at_(layout.known(problem)) {
    for (const MeasurementRow& row : problem.rows) reached_.push_back(problem.nominal.forward(row.axes));
  }

  std::vector<Surroundings> run() {
    const Surroundings known = at_;
    std::vector<Surroundings> found;
    // A tool that hardly turns leaves the frame open in its orientations, and positions tell it.
    for (const bool orientations_first : {true, false})
      for (const bool linear : {true, false}) {
        at_ = known;
        frame_turned_.clear();
        target_turned_.clear();
        for (const Slot& slot : layout_.frames) frame_turned_.push_back(slot.known);
        for (const Slot& slot : layout_.targets) target_turned_.push_back(slot.known);
        if (orientations_first) turns_by_orientations();
        turns_by_positions(linear);
        if (!orientations_first) turns_by_orientations();
        positions();
        points();
        anchors();
        planes();
        found.push_back(at_);
      }
    return found;
  }

 private:
  const MeasurementRow& row(std::size_t j) const { return problem_.rows[j]; }
  std::size_t target(std::size_t j) const { return static_cast<std::size_t>(layout_.rows[j].target); }
  std::size_t place(std::size_t j) const { return static_cast<std::size_t>(layout_.rows[j].place); }
  std::size_t frame(std::size_t j) const { return static_cast<std::size_t>(layout_.rows[j].frame); }

  void turns_by_orientations();
  void turns_by_positions(bool linear);
  void positions();
  void points();
  void anchors();
  void planes();
  /// The position of G by the start so far.
  Vec3 reached_target(std::size_t j) const { return reached_[j] * at_.targets[target(j)].translation(); }

  const RowProblem& problem_;
  const SurroundingsLayout& layout_;
  Surroundings at_;
  std::vector<Pose> reached_;
  std::vector<bool> frame_turned_, target_turned_;
};

/// Frame by frame and target by target, those that have the most rows in common with what is known first.
void Starter::turns_by_orientations() {
  while (true) {
    std::size_t best = problem_.rows.size();
    int best_known = -1;
    for (std::size_t j = 0; j < problem_.rows.size(); ++j) {
      if (!has_turn(row(j).kind)) continue;
      const int known = (frame_turned_[frame(j)] ? 1 : 0) + (target_turned_[target(j)] ? 1 : 0);
      if (known < 2 && known > best_known) best = j, best_known = known;
    }
    if (best == problem_.rows.size()) return;
    std::vector<RotationPair> pairs;
    const std::size_t f = frame(best), t = target(best);
    for (std::size_t j = 0; j < problem_.rows.size(); ++j)
      if (has_turn(row(j).kind) && frame(j) == f && target(j) == t)
        pairs.push_back({row(j).X_MG.linear(), reached_[j].linear()});
    Mat3 F = at_.frames[f].linear(), G = at_.targets[t].linear();
    if (frame_turned_[f]) {
      Mat3 sum = Mat3::Zero();
      for (const RotationPair& pair : pairs) sum += (F * pair.reached).transpose() * pair.measured;
      G = nearest_rotation(sum);
    } else if (target_turned_[t]) {
      Mat3 sum = Mat3::Zero();
      for (const RotationPair& pair : pairs) sum += pair.measured * (pair.reached * G).transpose();
      F = nearest_rotation(sum);
    } else {
      rotations_between(pairs, F, G);
    }
    at_.frames[f].linear() = F;
    at_.targets[t].linear() = G;
    frame_turned_[f] = target_turned_[t] = true;
  }
}

/// Frames by positions: with Q = R_SM, p_S + R t = Q p_M + c is linear in Q, c and the targets'
/// t, which need not make Q a rotation; or Q by the tips alone, as if the targets were there.
void Starter::turns_by_positions(bool linear) {
  for (std::size_t f = 0; f < layout_.frames.size(); ++f) {
    if (frame_turned_[f]) continue;
    std::vector<std::size_t> rows;
    for (std::size_t j = 0; j < problem_.rows.size(); ++j)
      if ((row(j).kind == RowKind::position || row(j).kind == RowKind::pose) && frame(j) == f)
        rows.push_back(j);
    if (rows.empty()) continue;
    frame_turned_[f] = true;
    Vec3 middle_M = Vec3::Zero(), middle_S = Vec3::Zero();
    for (const std::size_t j : rows) {
      middle_M += row(j).X_MG.translation() / static_cast<double>(rows.size());
      middle_S += reached_target(j) / static_cast<double>(rows.size());
    }
    Mat3 Q = Mat3::Zero();
    if (linear) {
      MatrixXd A = MatrixXd::Zero(3 * static_cast<Index>(rows.size()),
                                  12 + 3 * static_cast<Index>(layout_.targets.size()));
      VectorXd b(A.rows());
      Index at = 0;
      for (const std::size_t j : rows) {
        const Vec3 p = row(j).X_MG.translation() - middle_M;
        for (Index k = 0; k < 3; ++k) A.block<1, 3>(at + k, 3 * k) = p.transpose();
        A.block<3, 3>(at, 9).setIdentity();
        if (!layout_.targets[target(j)].known)
          A.block<3, 3>(at, 12 + 3 * static_cast<Index>(target(j))) = -reached_[j].linear();
        b.segment<3>(at) = reached_target(j) - middle_S;
        at += 3;
      }
      const VectorXd x = least_norm(A, b);
      for (Index k = 0; k < 3; ++k) Q.row(k) = x.segment<3>(3 * k).transpose();
    } else {
      for (const std::size_t j : rows)
        Q += (reached_target(j) - middle_S) * (row(j).X_MG.translation() - middle_M).transpose();
    }
    at_.frames[f].linear() = nearest_rotation(Q).transpose();
  }
}

/// All frames' and targets' positions that rows in frames tell, now that turns are known: p_M = R_MS (p + R
/// t) + m.
void Starter::positions() {
  const Index frames = static_cast<Index>(layout_.frames.size()),
              targets = static_cast<Index>(layout_.targets.size());
  std::vector<std::size_t> rows;
  for (std::size_t j = 0; j < problem_.rows.size(); ++j)
    if (in_frame(row(j).kind) && row(j).kind != RowKind::orientation) rows.push_back(j);
  if (rows.empty()) return;
  MatrixXd A = MatrixXd::Zero(3 * static_cast<Index>(rows.size()), 3 * (frames + targets));
  VectorXd b(A.rows());
  Index at = 0;
  for (const std::size_t j : rows) {
    const Mat3 R_MS = at_.frames[frame(j)].linear();
    if (!layout_.frames[frame(j)].known) A.block<3, 3>(at, 3 * static_cast<Index>(frame(j))).setIdentity();
    const bool known = layout_.targets[target(j)].known;
    if (!known) A.block<3, 3>(at, 3 * (frames + static_cast<Index>(target(j)))) = R_MS * reached_[j].linear();
    const Vec3 reached = known ? reached_target(j) : Vec3(reached_[j].translation());
    b.segment<3>(at) = row(j).X_MG.translation() - R_MS * reached;
    if (layout_.frames[frame(j)].known) b.segment<3>(at) -= at_.frames[frame(j)].translation();
    at += 3;
  }
  const VectorXd x = least_norm(A, b);
  for (Index f = 0; f < frames; ++f)
    if (!layout_.frames[static_cast<std::size_t>(f)].known)
      at_.frames[static_cast<std::size_t>(f)].translation() = x.segment<3>(3 * f);
  for (Index t = 0; t < targets; ++t)
    if (!layout_.targets[static_cast<std::size_t>(t)].known)
      at_.targets[static_cast<std::size_t>(t)].translation() = x.segment<3>(3 * (frames + t));
}

/// Points, and targets that no row in a frame tells: p + R t = s.
void Starter::points() {
  std::vector<bool> in_a_frame(layout_.targets.size(), false);
  std::vector<std::size_t> rows;
  for (std::size_t j = 0; j < problem_.rows.size(); ++j) {
    if (row(j).kind == RowKind::point) rows.push_back(j);
    if (row(j).kind == RowKind::pose || row(j).kind == RowKind::position) in_a_frame[target(j)] = true;
  }
  if (rows.empty()) return;
  const Index places = static_cast<Index>(layout_.points.size()),
              targets = static_cast<Index>(layout_.targets.size());
  MatrixXd A = MatrixXd::Zero(3 * static_cast<Index>(rows.size()), 3 * (places + targets));
  VectorXd b(A.rows());
  Index at = 0;
  for (const std::size_t j : rows) {
    const bool free = !layout_.targets[target(j)].known && !in_a_frame[target(j)];
    if (free) A.block<3, 3>(at, 3 * (places + static_cast<Index>(target(j)))) = -reached_[j].linear();
    b.segment<3>(at) = free ? Vec3(reached_[j].translation()) : reached_target(j);
    if (layout_.points[place(j)].known)
      b.segment<3>(at) -= at_.points[place(j)];
    else
      A.block<3, 3>(at, 3 * static_cast<Index>(place(j))).setIdentity();
    at += 3;
  }
  const VectorXd x = least_norm(A, b);
  for (Index p = 0; p < places; ++p)
    if (!layout_.points[static_cast<std::size_t>(p)].known)
      at_.points[static_cast<std::size_t>(p)] = x.segment<3>(3 * p);
  for (const std::size_t j : rows)
    if (!layout_.targets[target(j)].known && !in_a_frame[target(j)])
      at_.targets[target(j)].translation() = x.segment<3>(3 * (places + static_cast<Index>(target(j))));
}

/// (d - z)^2 = |p|^2 - 2 p . a + |a|^2, linear in a, z and |a|^2 - z^2.
void Starter::anchors() {
  for (std::size_t k = 0; k < layout_.anchors.size(); ++k) {
    if (layout_.anchors[k].known) continue;
    std::vector<std::size_t> rows;
    Vec3 middle = Vec3::Zero();
    for (std::size_t j = 0; j < problem_.rows.size(); ++j)
      if (row(j).kind == RowKind::distance && place(j) == k) rows.push_back(j), middle += reached_target(j);
    middle /= static_cast<double>(rows.size());
    const bool zero = layout_.anchors[k].turn >= 0;
    MatrixXd A(static_cast<Index>(rows.size()), zero ? 5 : 4);
    VectorXd b(A.rows());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Vec3 p = reached_target(rows[i]) - middle;
      const double d = row(rows[i]).distance - at_.zeros[k];
      A.block<1, 3>(static_cast<Index>(i), 0) = -2 * p.transpose();
      A(static_cast<Index>(i), 3) = 1;
      if (zero) A(static_cast<Index>(i), 4) = 2 * d;
      b[static_cast<Index>(i)] = d * d - p.squaredNorm();
    }
    const VectorXd x = least_norm(A, b);
    at_.anchors[k] = middle + x.head<3>();
    if (zero) at_.zeros[k] = x[4];
  }
}

void Starter::planes() {
  for (std::size_t k = 0; k < layout_.planes.size(); ++k) {
    if (layout_.planes[k].known) continue;
    Vec3 middle = Vec3::Zero();
    Mat3 spread = Mat3::Zero();
    std::vector<Vec3> touched;
    for (std::size_t j = 0; j < problem_.rows.size(); ++j)
      if (row(j).kind == RowKind::plane && place(j) == k) touched.push_back(reached_target(j));
    for (const Vec3& p : touched) middle += p / static_cast<double>(touched.size());
    for (const Vec3& p : touched) spread += (p - middle) * (p - middle).transpose();
    at_.planes[k].normal = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0);
    at_.planes[k].offset = at_.planes[k].normal.dot(middle);
  }
}

}  // namespace

/// measured G^T = F reached is linear and homogeneous in both; the eigenvector of the smallest eigenvalue.
bool rotations_between(const std::vector<RotationPair>& pairs, Mat3& F, Mat3& G) {
  if (pairs.empty()) return false;
  Eigen::Matrix<double, 18, 18> normal = Eigen::Matrix<double, 18, 18>::Zero();
  for (const RotationPair& pair : pairs) {
    Eigen::Matrix<double, 9, 18> rows = Eigen::Matrix<double, 9, 18>::Zero();
    // Columns of G^T, then of F, one below the other.
    for (Index column = 0; column < 3; ++column) {
      rows.block<3, 3>(3 * column, 3 * column) = pair.measured;
      for (Index k = 0; k < 3; ++k)
        rows.block<3, 3>(3 * column, 9 + 3 * k) = -pair.reached(k, column) * Mat3::Identity();
    }
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 18, 18>> eigen(normal);
  const Eigen::Matrix<double, 18, 1> x = eigen.eigenvectors().col(0);
  Mat3 H = Eigen::Map<const Mat3>(x.data()), from = Eigen::Map<const Mat3>(x.data() + 9);
  if (from.determinant() < 0) H = -H, from = -from;
  F = nearest_rotation(from);
  // G by all rows, given F.
  Mat3 sum = Mat3::Zero();
  for (const RotationPair& pair : pairs) sum += (F * pair.reached).transpose() * pair.measured;
  G = nearest_rotation(sum);
  return true;
}

std::vector<Surroundings> starts(const RowProblem& problem, const SurroundingsLayout& layout) {
  return Starter(problem, layout).run();
}

}  // namespace understudy::calibration
