// Calibration of an open chain (the arm) from measured tool poses: the line of every axis, its zero, the
// tool's mount and the measuring frame, in the chain's product of exponentials. Small motions of a screw stay
// well defined where neighbouring axes are parallel, which Denavit-Hartenberg parameters do not.
//
// More parameters are listed than poses can tell: of a chain with R turning and P sliding axes, 4 R + 2 P + 6
// (Everett 1987). The redundant ones are recognised, named and left as they are.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/problem.h"
#include "kinematics/chain/chain.h"

namespace understudy::calibration {

struct ChainSample {
  std::vector<double> axes;            ///< readings [m] or [rad]
  Pose X_ST = Pose::Identity();        ///< measured: the tool seen from the work
  Mat6 covariance = Mat6::Identity();  ///< (tip, rotation vector) in S, as PoseSample::covariance
};

/// A machine whose axes stand at reading + zero.
struct ChainParameters {
  kinematics::Chain chain;
  std::vector<double> zero;  ///< [m] or [rad], one an axis; empty: all 0
};

struct ChainProblem {
  ChainParameters nominal;
  std::vector<ChainSample> samples;
};

/// Residuals are in S.
struct ChainCalibration : Estimation {
  ChainParameters parameters;          ///< the nominal ones unless ok or not converged
  std::vector<std::string> estimated;  ///< names of what was estimated: "j2 tilt u", "tool x"
  std::vector<std::string> redundant;  ///< what these poses cannot tell beside the others
  Eigen::MatrixXd covariance;          ///< of `estimated`; [m], [rad]
};

Pose forward(const ChainParameters& machine, const std::vector<double>& readings);

/// u and v of the axis's parameters: unit vectors across it, in O.
std::array<Vec3, 2> across(const kinematics::ChainAxis& axis);

/// Names of all parameters, in the order in which a redundant one gives way to those before it.
std::vector<std::string> chain_parameter_names(const kinematics::Chain& chain);

/// How many of them poses can tell: 4 of an axis that turns, 2 of one that slides, 6 of tool and frame.
int independent_parameters(const kinematics::Chain& chain);

/// d (tip, rotation) / d parameters, in S.
Eigen::MatrixXd chain_rows(const ChainParameters& machine, const std::vector<double>& readings);

/// The machine with its parameters moved by `by`, in the same order.
ChainParameters moved(const ChainParameters& from, const Eigen::VectorXd& by);

/// Gauss-Newton on the likelihood of the measured poses. Never throws.
ChainCalibration calibrate_chain(const ChainParameters& nominal, const std::vector<ChainSample>& samples,
                                 int max_iterations = Options{}.max_iterations);

/// The same over the poses that agree, three quarters of them at least (trimmed_search.h); the others are
/// named in a warning. Refuses poses too few to leave one out. Never throws.
ChainCalibration calibrate_chain_robust(const ChainParameters& nominal,
                                        const std::vector<ChainSample>& samples, const Options& options = {});

}  // namespace understudy::calibration
