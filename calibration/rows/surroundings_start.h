// Where measuring frames, targets, points, anchors and planes are, by the nominal machine: linear equations,
// as a start for the fit.
#pragma once

#include <vector>

#include "calibration/rows/row_equations.h"

namespace understudy::calibration {

/// Several, where the linear equations of positions may be ill; the fit takes the one that it likes best.
std::vector<Surroundings> starts(const RowProblem& problem, const SurroundingsLayout& layout);

/// Rotations F and G with measured_i = F reached_i G as well as may be; F or G is left where it is known.
/// False where the rows do not tell (none).
struct RotationPair {
  Mat3 measured = Mat3::Identity(), reached = Mat3::Identity();
};
bool rotations_between(const std::vector<RotationPair>& pairs, Mat3& F, Mat3& G);

}  // namespace understudy::calibration
