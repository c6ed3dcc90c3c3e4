// From a fit to what the user gets: residuals of the measured poses, chi-square and warnings.
#pragma once

#include <string>

#include "calibration/estimators/fit.h"
#include "calibration/identifiability.h"

namespace understudy::calibration {

/// Fills everything but the covariance. Not converged is a status with advice.
Calibration calibrated(const Problem& problem, const Fit& fit, const Unknowns& unknowns,
                       const std::vector<bool>& used);

/// Where residuals are not what the stated noise explains, on either side; empty where they are. `lacking`:
/// what a model may lack.
std::string misfit_warning(double chi_square, int degrees, const char* lacking);

/// The nominal machine with a reason.
Calibration refused(const Problem& problem, Status status, const std::string& message);
Calibration refused(const Problem& problem, const Identifiability& found);

/// Residuals of all samples about result.parameters, chi-square and degrees of freedom of result.used.
/// Returns the index of the first sample that this machine cannot reach.
std::optional<std::size_t> add_residuals(const Problem& problem, const Unknowns& unknowns,
                                         Calibration& result);

/// Measured less reached: (translation, rotation vector), both in B.
Twist pose_error(const Pose& measured, const Pose& reached);

}  // namespace understudy::calibration
