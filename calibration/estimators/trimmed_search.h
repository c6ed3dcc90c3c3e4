// Which poses agree on a machine: reweighted least trimmed squares over whole poses (Rousseeuw and Van
// Driessen 2006). A target taken for another, a reflection or a touched tool spoils one pose with all its
// numbers.
//  1. Many fits to a few random poses; each is improved by keeping the h poses nearest to it (C-steps).
//  2. The one with the smallest trimmed sum starts; poses join while they are plausible beside the fit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"

namespace understudy::calibration {

/// All that the search knows of a model.
class PoseFit {
 public:
  virtual ~PoseFit() = default;
  /// Fits the poses with used[j], always from the same start, in `iterations` at most, and tells the squared
  /// distance of every pose from the fit. A pose in the fit has pulled it and is measured by its own
  /// covariance, S; one outside has not, and is measured by S + G C G^T, where C is the fit's. Infinite: the
  /// model has no answer. False, with distances as they were: these poses do not tell the parameters.
  virtual bool fit(const std::vector<bool>& used, int iterations, std::vector<double>& distances) = 0;
};

/// Of one random start: one more than `parameters` need at six numbers a pose, since just enough of them
/// often tell a parameter ill.
std::size_t start_poses(int parameters);

struct TrimmedSearch {
  std::size_t poses = 0;
  int parameters = 0;      ///< that the poses tell
  int iterations = 50;     ///< of each fit as poses join
  std::uint64_t seed = 1;  ///< of the starts
  Progress progress = {};
};

/// used[j] of the poses that agree, three quarters of them at least; empty where no start led to a fit.
std::vector<bool> agreeing_poses(PoseFit& model, const TrimmedSearch& search);

/// "rejected as outliers: poses 3, 7", counted from 1; empty where all are used.
std::string rejection_warning(const std::vector<bool>& used);

}  // namespace understudy::calibration
