#include "calibration/machine/axis_signs.h"

#include <algorithm>

namespace understudy::calibration {
namespace {

constexpr double kSuspect = 2e-3, kSuspectTurn = 10e-3;  // [m], [rad]
constexpr double kMuch = 3;                              // by this factor the other sign must fit better

bool suspect(const RowCalibration& found) {
  return std::any_of(found.parts.begin(), found.parts.end(), [](const PartReport& part) {
    return part.after > (part.name == "turn" ? kSuspectTurn : kSuspect);
  });
}

/// Every part of `a` is below that of `b` by the factor.
bool below(const RowCalibration& a, const RowCalibration& b, double factor) {
  if (!a.ok() || a.parts.empty() || a.parts.size() != b.parts.size()) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i)
    if (!(factor * a.parts[i].after < b.parts[i].after)) return false;
  return true;
}

RowProblem with_turned(RowProblem problem, std::size_t axis) {
  for (MeasurementRow& row : problem.rows) row.axes[axis] *= -1;
  return problem;
}

}  // namespace

std::optional<TurnedAxis> turned_axis(const RowProblem& problem, const RowCalibration& found) {
  const ChainParameters* chain = problem.nominal.chain();
  if (!chain || !suspect(found)) return std::nullopt;
  const RowCalibration drawn = calibrate_rows(problem, {.machine = false});
  for (std::size_t axis = 0; axis < chain->chain.axes.size(); ++axis) {
    const RowProblem turned = with_turned(problem, axis);
    if (!below(calibrate_rows(turned, {.machine = false}), drawn, 1)) continue;
    const RowCalibration other = calibrate_rows(turned);
    if (!below(other, found, kMuch)) continue;
    const PartReport& part = found.parts.front();
    return TurnedAxis{chain->chain.axes[axis].name, part.after, other.parts.front().after,
                      part.name == "turn"};
  }
  return std::nullopt;
}

}  // namespace understudy::calibration
