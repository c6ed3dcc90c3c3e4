#include "studies/calibration/driven_model.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "calibration/machine/strut_sides.h"
#include "calibration/strut_model.h"

namespace understudy::studies {

using namespace calibration;
using Eigen::Index;

bool DrivenModel::displacements(const machine::MachineDescription& machine, const Pose& X_BT,
                                StrutLengths& displacement) const {
  StrutLengths lengths;
  if (kinematics::inverse(parameters.geometry, X_BT, lengths) != kinematics::SolveStatus::ok) return false;
  const auto sides = probable_sides(machine, parameters.geometry, X_BT);
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double play = allows_for_play ? 0.5 * parameters.play[i] * sides[i] : 0;
    displacement[i] = (lengths[i] - parameters.geometry.length_offset[i] + play) / (1 + lead[i]);
  }
  return true;
}

ErrorModel tip_errors_of(const BundleProblem& problem, const DrivenModel& model,
                         const machine::MachineDescription& machine, std::span<const Pose> X_BT) {
  const Index own = problem.unknowns.count(), leads = problem.leads_unknown() ? kStruts : 0;
  const Index count = own + leads + (problem.warms() ? kWarmingTerms : 0);
  ErrorModel errors{Eigen::MatrixXd::Zero(3 * static_cast<Index>(X_BT.size()), count), {}};
  for (std::size_t k = 0; k < X_BT.size(); ++k) {
    PoseSample sample;
    StrutLinearisation at;
    if (!model.displacements(machine, X_BT[k], sample.displacement) ||
        !linearise(model.parameters, sample, X_BT[k], at))
      throw std::logic_error("a pose held out is out of reach");  // errors were found there
    const auto sides = probable_sides(machine, model.parameters.geometry, X_BT[k]);
    for (std::size_t i = 0; i < kStruts; ++i) at.by_play[static_cast<Index>(i)] = 0.5 * sides[i];
    const Mat6 by_length = at.by_pose.inverse();
    auto rows = errors.rows.middleRows<3>(3 * static_cast<Index>(k));
    rows.leftCols(own) = pose_rows(at, problem.unknowns).topRows<3>();
    for (Index i = 0; i < leads; ++i)
      rows.col(own + i) = by_length.col(i).head<3>() * sample.displacement[static_cast<std::size_t>(i)];
    Twist variance = Twist::Constant(std::pow(problem.drives.length, 2));
    kinematics::PerStrut<double> side_variance{};
    if (!side_variances(machine, model.parameters.geometry, machine.tolerances.after_calibration, X_BT[k],
                        side_variance))
      throw std::logic_error("a pose held out has no loads");
    for (std::size_t i = 0; i < kStruts && model.allows_for_play; ++i)
      variance[static_cast<Index>(i)] += std::pow(0.5 * model.parameters.play[i], 2) * side_variance[i];
    const auto tip = by_length.topRows<3>();
    errors.own.push_back(tip * variance.asDiagonal() * tip.transpose());
  }
  return errors;
}

}  // namespace understudy::studies
