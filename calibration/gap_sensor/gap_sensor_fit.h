// Mounting of laser and microscope from dots over flats: the most probable one beside the tolerances of
// mounting (maximum a posteriori), with its covariance.
//
// The dots of one flat tell gaps up to a constant, and a known gap tells that. What no dot shows stays at the
// drawing, as uncertain as the tolerances have it.
#pragma once

#include <vector>

#include "calibration/gap_sensor/flat_dot.h"

namespace understudy::calibration {

/// A dot that was measured.
struct SeenDot {
  int flat = 0;             ///< index into GapSensorProblem::slopes
  double height = 0;        ///< [m], commanded; the gap is more by a constant of the flat
  double height_sigma = 0;  ///< [m], of that height beside the others of its flat
  Vec2 position_px{0, 0};
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d spread_px2 = Eigen::Matrix2d::Zero();  ///< second central moments
  double spread_sigma = 0;  ///< of those, along any direction: a share of them; 0: the width is not known
};

/// A gap that was measured otherwise.
struct KnownGap {
  int flat = 0;
  double height = 0;  ///< [m], as above
  double gap = 0;     ///< [m], along the tool axis
  double sigma = 0;   ///< [m], above 0
};

struct GapSensorProblem {
  machine::OpticsMounting drawn;
  Camera camera;
  machine::MountingVector tolerance;  ///< 1 sigma; 0: known exactly
  /// [m] that the dot travels on the flat until its speckle is new; dots nearer to each other err alike.
  double speckle_length = 0;
  double waist = 0;          ///< [m], 1/e^2 diameter of the beam as drawn; 0: its width is not asked for
  double blur_px = 0;        ///< 1 sigma of the optics
  std::vector<Vec2> slopes;  ///< of each flat
  std::vector<SeenDot> dots;
  std::vector<KnownGap> known;  ///< at least one
};

struct GapSensorFit {
  bool converged = false;
  machine::OpticsMounting mounting;
  machine::MountingVector error;        ///< of the drawing: moved(drawn, error) is the mounting
  machine::MountingMatrix covariance;   ///< of the mounting's remaining error
  std::vector<double> zero;             ///< [m], gap less height, of each flat
  std::vector<double> zero_sigma;       ///< [m]
  std::vector<Vec2> residual_px;        ///< of each dot, measured less fitted
  std::vector<double> residual_sigmas;  ///< of each dot, its distance in standard deviations
  double chi_square = 0;                ///< dots, known gaps and tolerances together
  int degrees_of_freedom = 0;
  int iterations = 0;
  double waist = 0;        ///< [m], as the dots show it; 0: they do not
  double waist_sigma = 0;  ///< [m]
};

/// Levenberg-Marquardt from the drawing. Not converged: the optics as drawn see no dot of such a flat.
GapSensorFit fit_gap_sensor(const GapSensorProblem& problem);

}  // namespace understudy::calibration
