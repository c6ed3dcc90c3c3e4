#include "calibration/rows/row_equations.h"

#include "calibration/calibrated.h"
#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// What the equations of one row are written into.
class RowWriter {
 public:
  RowWriter(const SurroundingsLayout& layout, const RowState& at, RowEquations& out)
      : layout_(layout), at_(at), out_(out) {}

  void write(const MeasurementRow& row, const SurroundingsLayout::Use& use, Index first, bool with_machine);

 private:
  void measured_in_frame(const MeasurementRow& row, const SurroundingsLayout::Use& use, Index first);
  void distance(const MeasurementRow& row, std::size_t anchor, Index first);
  void point(std::size_t place, Index first);
  void plane(std::size_t place, Index first);
  void put_machine(Index first, const MatrixXd& block) {
    if (block.cols() > 0) out_.machine.middleRows(first, block.rows()) = block;
  }
  /// Three numbers, or their product with `by`, of G's position.
  void move_target(const MatrixXd& by, Index first);
  void put(Index first, Index column, const MatrixXd& block) {
    if (column >= 0) out_.around.block(first, column, block.rows(), block.cols()) = block;
  }

  const SurroundingsLayout& layout_;
  const RowState& at_;
  RowEquations& out_;
  // Of the row at hand:
  const SurroundingsLayout::Slot* target_ = nullptr;
  Pose X_ST_ = Pose::Identity(), X_SG_ = Pose::Identity();
  MatrixXd tip_, turn_;  // d (position of G, rotation) / d machine, in S
};

void RowWriter::write(const MeasurementRow& row, const SurroundingsLayout::Use& use, Index first,
                      bool with_machine) {
  const auto target = static_cast<std::size_t>(use.target);
  target_ = &layout_.targets[target];
  X_ST_ = at_.machine.forward(row.axes);
  X_SG_ = X_ST_ * at_.around.targets[target];
  tip_.resize(3, 0);
  turn_.resize(3, 0);
  if (with_machine) {
    const MatrixXd rows = at_.machine.parameter_rows(row.axes, X_ST_);
    turn_ = rows.bottomRows<3>();
    tip_ = rows.topRows<3>() - cross_matrix(X_SG_.translation() - X_ST_.translation()) * turn_;
  }
  const auto place = static_cast<std::size_t>(use.place);
  switch (row.kind) {
    case RowKind::distance:
      return distance(row, place, first);
    case RowKind::point:
      return point(place, first);
    case RowKind::plane:
      return plane(place, first);
    default:
      return measured_in_frame(row, use, first);
  }
}

void RowWriter::move_target(const MatrixXd& by, Index first) {
  put_machine(first, by * tip_);
  put(first, target_->position, by * X_ST_.linear());
}

void RowWriter::measured_in_frame(const MeasurementRow& row, const SurroundingsLayout::Use& use,
                                  Index first) {
  const auto frame = static_cast<std::size_t>(use.frame);
  const Pose& X_MS = at_.around.frames[frame];
  const Mat3 R_MS = X_MS.linear();
  const Pose X_MG = X_MS * X_SG_;
  const Twist error = pose_error(row.X_MG, X_MG);
  if (row.kind != RowKind::orientation) {
    out_.error.segment<3>(first) = error.head<3>();
    move_target(R_MS, first);
    put(first, layout_.frames[frame].position, Mat3::Identity());
    put(first, layout_.frames[frame].turn, -cross_matrix(X_MG.translation() - X_MS.translation()));
    first += 3;
  }
  if (row.kind == RowKind::position) return;
  out_.error.segment<3>(first) = error.tail<3>();
  put_machine(first, R_MS * turn_);
  put(first, target_->turn, X_MG.linear());
  put(first, layout_.frames[frame].turn, Mat3::Identity());
}

void RowWriter::distance(const MeasurementRow& row, std::size_t anchor, Index first) {
  const Vec3 from = X_SG_.translation() - at_.around.anchors[anchor];
  const double length = from.norm();
  const Vec3 along = length > 0 ? Vec3(from / length) : Vec3::UnitZ();
  out_.error[first] = row.distance - length - at_.around.zeros[anchor];
  move_target(along.transpose(), first);
  put(first, layout_.anchors[anchor].position, -along.transpose());
  put(first, layout_.anchors[anchor].turn, MatrixXd::Ones(1, 1));
}

void RowWriter::point(std::size_t place, Index first) {
  out_.error.segment<3>(first) = at_.around.points[place] - X_SG_.translation();
  move_target(Mat3::Identity(), first);
  put(first, layout_.points[place].position, -Mat3::Identity());
}

void RowWriter::plane(std::size_t place, Index first) {
  const Plane& plane = at_.around.planes[place];
  const Vec3 p = X_SG_.translation();
  const auto [u, v] = across(plane.normal);
  out_.error[first] = plane.offset - plane.normal.dot(p);
  move_target(plane.normal.transpose(), first);
  put(first, layout_.planes[place].position,
      Eigen::RowVector3d(u.cross(plane.normal).dot(p), v.cross(plane.normal).dot(p), -1));
}

}  // namespace

std::vector<Index> first_equations(const RowProblem& problem) {
  std::vector<Index> first{0};
  for (const MeasurementRow& row : problem.rows) first.push_back(first.back() + equations_of(row.kind));
  return first;
}

RowEquations row_equations(const RowProblem& problem, const SurroundingsLayout& layout, const RowState& at,
                           bool with_machine) {
  const std::vector<Index> first = first_equations(problem);
  const Index equations = first.back() + static_cast<Index>(problem.distances.size());
  const Index parameters = with_machine ? static_cast<Index>(at.machine.parameters().size()) : 0;
  RowEquations out;
  out.error = Eigen::VectorXd::Zero(equations);
  out.machine = MatrixXd::Zero(equations, parameters);
  out.around = MatrixXd::Zero(equations, layout.columns());
  RowWriter writer(layout, at, out);
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    writer.write(problem.rows[j], layout.rows[j], first[j], with_machine);
  for (std::size_t k = 0; k < problem.distances.size(); ++k) {
    const auto [a, b] = layout.distances[k];
    const Vec3 from =
        at.around.points[static_cast<std::size_t>(a)] - at.around.points[static_cast<std::size_t>(b)];
    const Vec3 along = from.norm() > 0 ? Vec3(from.normalized()) : Vec3::UnitZ();
    const Index row = first.back() + static_cast<Index>(k);
    out.error[row] = problem.distances[k].length - from.norm();
    const auto put = [&](int point, const Vec3& by) {
      const Index column = layout.points[static_cast<std::size_t>(point)].position;
      if (column >= 0) out.around.block<1, 3>(row, column) = by.transpose();
    };
    put(a, along);
    put(b, -along);
  }
  return out;
}

MatrixXd jacobian(const RowEquations& equations, const std::vector<Index>& unknowns) {
  const Index around = equations.around.cols();
  const Index machine = equations.machine.cols() > 0 ? static_cast<Index>(unknowns.size()) : 0;
  MatrixXd J(equations.error.size(), machine + around);
  if (machine > 0) J.leftCols(machine) = equations.machine(Eigen::all, unknowns);
  if (around > 0) J.rightCols(around) = equations.around;
  return J;
}

}  // namespace understudy::calibration
