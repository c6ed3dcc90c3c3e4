// How wide the beam is, from how wide its dots are over flats: what the controller tells a whole dot by.
#pragma once

#include <optional>

#include "calibration/gap_sensor/gap_sensor_fit.h"

namespace understudy::calibration {

struct Waist {
  double diameter = 0;  ///< [m], 1/e^2
  double sigma = 0;     ///< [m]
};

/// Of the noise of dots: speckle fades while a dot travels on its flat, and flats are apart. `zero` [m] is
/// gap less height of each flat.
Eigen::MatrixXd speckle_correlation(const GapSensorProblem& problem, const std::vector<double>& zero);

/// Weighted mean over the dots of the beam's width, seen through the drawn blur: what the blur differs by
/// counts as the beam's. Where dots scatter more than they state, their scatter counts. Nothing where no dot
/// tells its width, or none is as wide as the blur alone.
std::optional<Waist> fit_waist(const GapSensorProblem& problem, const machine::OpticsMounting& mounting,
                               const std::vector<double>& zero);

}  // namespace understudy::calibration
