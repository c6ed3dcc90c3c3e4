// The velocity of a task by the axes' velocities, and what to do where it has lost rank. The decomposition of
// Eigen takes long to compile: it stands in one source, for every size of task.
#pragma once

#include "kinematics/axis_vector.h"

namespace understudy::kinematics {

constexpr int kTaskMax = 6;

/// Row per dimension of the task, column per axis; angles as lengths on both sides, so that one scale fits
/// all.
using TaskJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kTaskMax, kMaxAxes>;
using TaskColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kTaskMax, 1>;
using TaskRows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kTaskMax, 6>;
using AxisRows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxAxes, 6>;

/// The smallest y nearest to J y = wanted: by a pivoted QR decomposition, of whose pivots those below 1e-9 of
/// the largest count as zero. False where that is so of any: J has lost rank. Never allocates.
bool solve_minimum_norm(const TaskJacobian& J, const TaskColumn& wanted, AxisColumn& y);
/// Column by column.
bool solve_minimum_norm(const TaskJacobian& J, const TaskRows& wanted, AxisRows& y);

/// Largest over smallest singular value of the rows of J; `worst` where it is above, as with fewer columns
/// than rows.
double condition_number(const TaskJacobian& J, double worst);

}  // namespace understudy::kinematics
