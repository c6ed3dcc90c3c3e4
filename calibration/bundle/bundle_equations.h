// Private to this folder: the equations of a bundle adjustment about a state, and how a step moves it.
#pragma once

#include "calibration/bundle/arrow_equations.h"
#include "calibration/bundle/bundle_problem.h"
#include "vision/boards/pixel_slopes.h"

namespace understudy::calibration {

/// Where the shared unknowns stand in their vector: cameras, prints, machine, leads, warming. Local blocks
/// are the boards (offset, rotation, scale), then the poses (translation, rotation vector, both in B).
struct BundleLayout {
  explicit BundleLayout(const BundleProblem& problem);

  static constexpr Eigen::Index kPrint = 4;  ///< scale and bow
  static constexpr Eigen::Index kPlacement = 7, kPose = 6;

  Eigen::Index camera(int i) const { return Eigen::Index{vision::kCameraNumbers} * i; }
  Eigen::Index print(int i) const { return 2 * Eigen::Index{vision::kCameraNumbers} + kPrint * i; }
  Eigen::Index machine() const { return print(2); }
  Eigen::Index lead() const { return machine() + unknowns.count(); }
  Eigen::Index warming() const { return lead() + (leads ? kStruts : 0); }
  Eigen::Index count() const { return warming() + (warms ? kWarmingTerms : 0); }
  std::vector<Eigen::Index> block_sizes() const;

  Unknowns unknowns;
  bool leads, warms;
  std::size_t boards, poses;
};

/// False where the model has no answer: a point behind a camera, a strut shorter than dev.
bool gather(const BundleProblem& problem, const BundleState& state, ArrowEquations& equations);

BundleState moved(const BundleProblem& problem, const BundleState& from, const ArrowEquations::Step& by);

}  // namespace understudy::calibration
