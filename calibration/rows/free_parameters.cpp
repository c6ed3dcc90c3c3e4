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

}  // namespace

std::vector<Index> free_parameters(const ChainParameters& nominal, bool base_free, bool tool_free) {
  const auto parameters = static_cast<Index>(chain_parameter_names(nominal.chain).size());
  const Index around = (base_free ? 6 : 0) + (tool_free ? 6 : 0);
  Eigen::MatrixXd J(6 * kPoses, around + parameters);
  Random random(1, "free parameters");
  for (Index pose = 0; pose < kPoses; ++pose) {
    std::vector<double> axes;
    for (const auto& axis : nominal.chain.axes) axes.push_back(drawn(axis, random));
    const Pose X = forward(nominal, axes);
    Mat6 by_frame = Mat6::Identity(), by_target = Mat6::Zero();
    by_frame.topRightCorner<3, 3>() = -cross_matrix(X.translation());
    by_target.topLeftCorner<3, 3>() = by_target.bottomRightCorner<3, 3>() = X.linear();
    auto rows = J.middleRows<6>(6 * pose);
    if (base_free) rows.leftCols<6>() = by_frame;
    if (tool_free) rows.middleCols<6>(base_free ? 6 : 0) = by_target;
    rows.rightCols(parameters) = chain_rows(nominal, axes);
  }
  // Of columns that can stand in for each other the first ones are kept: with a free base, the first axis
  // comes last.
  std::vector<Index> order(static_cast<std::size_t>(J.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  if (base_free && !nominal.chain.axes.empty()) {
    const auto first = order.begin() + around;
    std::rotate(first, first + (nominal.chain.axes.front().angle ? 5 : 3), order.end());
  }
  std::vector<Index> kept;
  for (const Index k : independent_columns(J(Eigen::all, order)))
    if (const Index column = order[static_cast<std::size_t>(k)]; column >= around)
      kept.push_back(column - around);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace understudy::calibration
