#pragma once

#include <vector>

#include <Eigen/Core>

namespace understudy::calibration {

/// Columns kept, from the first on: one that the kept ones before it explain is redundant.
std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& J);

}  // namespace understudy::calibration
