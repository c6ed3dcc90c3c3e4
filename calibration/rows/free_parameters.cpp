#include "calibration/rows/free_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "calibration/estimators/independent_columns.h"
#include "core/cross_matrix.h"
#include "core/random.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;

constexpr int kPoses = 40;           // 240 equations for at most 64 columns
constexpr double kSlideRange = 0.5;  // [m], of an axis without ends

double drawn(const kinematics::ChainAxis& axis, Random& random) {
  const double half = axis.angle ? std::numbers::pi : kSlideRange;
  const double low = std::isfinite(axis.lower) ? axis.lower : -half;
  const double high = std::isfinite(axis.upper) ? axis.upper : half;
  return random.uniform(low, high);
}

/// Six coordinates of `joints` that no motion of them all as one rigid body leaves in place; number 3 i + k
/// is coordinate k of joint i.
std::vector<std::size_t> holding(const kinematics::PerStrut<Vec3>& joints) {
  constexpr double kWellHeld = 0.2;  // of the longest lever
  double longest = 0;
  for (const Vec3& joint : joints) longest = std::max(longest, (joint - joints[0]).norm());
  std::vector<std::size_t> held{0, 1, 2};  // joint 1; what is left turns about it
  std::vector<Vec3> turns;                 // by which those held after it move, made orthonormal
  for (const std::size_t i : {2, 4, 1, 3, 5})
    for (const Index k : {2, 1, 0}) {
      Vec3 by = (joints[i] - joints[0]).cross(Vec3::Unit(k));
      for (const Vec3& turn : turns) by -= turn.dot(by) * turn;
      if (turns.size() == 3 || by.norm() < kWellHeld * longest) continue;
      turns.push_back(by.normalized());
      held.push_back(3 * i + static_cast<std::size_t>(k));
    }
  return held;
}

}  // namespace

std::vector<Index> free_parameters(const ChainParameters& nominal, bool base_free, bool tool_free,
                                   const StationaryAxes& stands) {
  const auto parameters = static_cast<Index>(chain_parameter_names(nominal.chain).size());
  const Index around = (base_free ? 6 : 0) + (tool_free ? 6 : 0);
  Eigen::MatrixXd J(6 * kPoses, around + parameters);
  Random random(1, "free parameters");
  for (Index pose = 0; pose < kPoses; ++pose) {
    std::vector<double> axes;
    for (std::size_t i = 0; i < nominal.chain.axes.size(); ++i) {
      const double reading = drawn(nominal.chain.axes[i], random);
      axes.push_back(stands.empty() ? reading : stands[i].value_or(reading));
    }
    const Pose X = forward(nominal, axes);
    Mat6 by_frame = Mat6::Identity(), by_target = Mat6::Zero();
    by_frame.topRightCorner<3, 3>() = -cross_matrix(X.translation());
    by_target.topLeftCorner<3, 3>() = by_target.bottomRightCorner<3, 3>() = X.linear();
    auto rows = J.middleRows<6>(6 * pose);
    if (base_free) rows.leftCols<6>() = by_frame;
    if (tool_free) rows.middleCols<6>(base_free ? 6 : 0) = by_target;
    rows.rightCols(parameters) = chain_rows(nominal, axes);
  }
  // Of columns that can stand in for each other the first ones are kept: those to be held come last.
  std::vector<Index> order(static_cast<std::size_t>(J.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::vector<Index> last = held_columns(nominal.chain, base_free, tool_free, stands);
  for (Index& column : last) column += around;
  std::erase_if(order,
                [&](Index column) { return std::find(last.begin(), last.end(), column) != last.end(); });
  order.insert(order.end(), last.begin(), last.end());
  std::vector<Index> kept;
  for (const Index k : independent_columns(J(Eigen::all, order)))
    if (const Index column = order[static_cast<std::size_t>(k)]; column >= around)
      kept.push_back(column - around);
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::vector<Index> free_parameters(const HexapodGeometry& nominal, bool base_free, bool tool_free) {
  std::vector<bool> kept(kGeometryParameters, true);
  const auto hold = [&kept](const kinematics::PerStrut<Vec3>& joints, std::size_t first) {
    for (const std::size_t k : holding(joints)) kept[kStrutParameters * (k / 3) + first + k % 3] = false;
  };
  if (base_free) hold(nominal.base_joint, 0);
  if (tool_free) hold(nominal.platform_joint, 3);
  std::vector<Index> columns;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (kept[k]) columns.push_back(static_cast<Index>(k));
  return columns;
}

}  // namespace understudy::calibration
