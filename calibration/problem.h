// A calibration of the hexapod: what was measured, what is unknown, and what comes out (Song 2015, section 4;
// docs/reference.md#identifiable-parameters). Everything is SI.
//
// The 42 parameters are, strut by strut, (b_i, a_i, l_i0): the base joint in B, the ball joint in T and the
// strut's length at displacement 0. Wherever parameters stand in a vector or matrix, number 7 i + k is the
// k-th of strut i; behind them `dev` where it is unknown, then the play of the six struts where that is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "kinematics/hexapod/hexapod.h"

namespace understudy::calibration {

using kinematics::HexapodGeometry;
using kinematics::kStruts;
using kinematics::StrutLengths;

constexpr int kStrutParameters = 7;
constexpr int kGeometryParameters = 42;
constexpr int kMaxParameters = 49;

template <int Rows>
using ParameterRows = Eigen::Matrix<double, Rows, Eigen::Dynamic, 0, Rows, kMaxParameters>;
using ParameterVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxParameters, 1>;
using ParameterMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;

/// From which side a strut came to where it stood.
enum class Approach : std::int8_t { shortening = -1, unknown = 0, lengthening = 1 };

/// One pose of the platform, held still and measured.
struct PoseSample {
  Pose X_BT = Pose::Identity();  ///< measured
  /// Of the measurement's error, (translation of the tip [m], rotation vector [rad]), both in B:
  /// measured = (p + e_p, exp(e_w) R). Positive definite.
  Mat6 covariance = Mat6::Identity();
  StrutLengths displacement{};  ///< [m], of the drives: commanded strut length less the nominal l_i0
  kinematics::PerStrut<Approach> approach{};
};

/// What is estimated beside the 42 parameters.
struct Unknowns {
  bool deviation = false;
  bool play = false;

  int count() const { return kGeometryParameters + (deviation ? 1 : 0) + (play ? kStruts : 0); }
  int first_play() const { return kGeometryParameters + (deviation ? 1 : 0); }
};

/// The machine as the model has it. A strut that came by lengthening is half its play shorter than its drive
/// says, one that came by shortening half its play longer.
struct HexapodParameters {
  HexapodGeometry geometry;
  StrutLengths play{};  ///< [m], total free travel along each strut
};

struct Problem {
  HexapodParameters nominal;  ///< where the search starts; what is not estimated stays as it is here
  std::vector<PoseSample> samples;
};

struct Options {
  int max_iterations = 50;
  std::uint64_t seed = 1;  ///< of estimators that draw subsets
  Progress progress = {};  ///< of estimators that may take long
};

enum class [[nodiscard]] Status{
    ok,
    bad_input,         ///< a number, a pose or a covariance that is none
    too_few_poses,     ///< fewer equations than unknowns
    repeated_poses,    ///< enough poses, too few different ones
    dead_measurement,  ///< a strut or an axis never changes
    no_rotation,       ///< the platform kept its orientation, or turned about one axis only
    rank_deficient,    ///< parameters that these poses cannot tell apart
    not_converged,
    unsupported,  ///< the estimator is not made for this kind of machine
    no_answer     ///< a plug-in gave none that can be used
};
const char* to_string(Status status);

/// What every estimator reports of any machine, in addition to its parameters.
struct Estimation {
  Status status = Status::not_converged;
  std::string message;                ///< one line that says what is missing; empty when ok
  std::optional<std::size_t> pose;    ///< index of the sample at fault, where it is one
  std::vector<std::string> warnings;  ///< where the data do not support the model
  std::vector<Twist> residuals;       ///< of each sample, measured less model, as in PoseSample::covariance
  std::vector<bool> used;             ///< false: rejected as an outlier
  int iterations = 0;
  double chi_square = 0;  ///< residuals of the used samples weighed by their covariances
  int degrees_of_freedom = 0;
  bool ok() const { return status == Status::ok; }
};

struct Calibration : Estimation {
  HexapodParameters parameters;  ///< the last iterate where not converged, else the nominal
  /// Of the estimated parameters, for the stated noise; empty unless ok, and where a plug-in gives none.
  ParameterMatrix covariance;
};

/// What is wrong with the samples. `message` is empty when nothing is, and names the pose, from 1.
struct Fault {
  std::string message;
  std::optional<std::size_t> pose;
};
/// "pose 8: " and `what`, with j = 7.
Fault fault_of_pose(std::size_t j, const std::string& what);

/// Displacements of lengths that a controller commanded with `nominal`.
StrutLengths displacements(const HexapodGeometry& nominal, const StrutLengths& lengths);

/// The strut lengths that displacements make on this machine.
StrutLengths strut_lengths(const HexapodParameters& machine, const PoseSample& sample);

/// `by` moved along the unknowns; its layout is that of Unknowns.
HexapodParameters moved(const HexapodParameters& from, const ParameterVector& by, const Unknowns& unknowns);

}  // namespace understudy::calibration
