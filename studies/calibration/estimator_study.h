// Estimators against the bound on one synthetic machine: the set-up of docs/reference.md#calibration-figures.
#pragma once

#include <functional>

#include "calibration/estimators/estimator.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"

namespace understudy::studies {

struct StudySetting {
  calibration::HexapodGeometry nominal;
  const kinematics::Mechanism* mechanism = nullptr;  ///< says what is reachable
  calibration::PoseRegion region;
  calibration::MeasurementNoise noise = calibration::kReferenceNoise;
  double parameter_sigma = 0.5e-3;  ///< [m]
  std::size_t held_out = 60;        ///< poses at which the tip error is taken
  std::size_t candidates = 300;     ///< that D-optimal poses are chosen from
  std::uint64_t seed = 1;           ///< of the machine and all that is drawn
};

enum class PoseChoice { random, d_optimal };

struct StudyPlan {
  std::size_t poses = 12;
  PoseChoice choice = PoseChoice::random;
  int sets = 8;    ///< of poses
  int draws = 12;  ///< of noise a set
};

/// One estimator over all sets and draws. Errors of the tip where the calibrated model sends it [m].
struct StudyResult {
  std::string estimator;
  double median = 0, p95 = 0;  ///< over held-out poses, sets and draws
  double rms = 0;
  double efficiency = 0;  ///< 1 / mean over sets of (mean squared error / bound^2)
  int runs = 0, failures = 0;
};

struct Study {
  std::vector<double> bounds;        ///< [m], Cramer-Rao bound's RMS of the tip, one a set, ascending
  double uncalibrated_median = 0;    ///< [m]
  std::vector<StudyResult> results;  ///< in the order asked for
};

/// Throws InputError for an estimator that is none.
Study run_study(const StudySetting& setting, const StudyPlan& plan, const std::vector<std::string>& names);

}  // namespace understudy::studies
