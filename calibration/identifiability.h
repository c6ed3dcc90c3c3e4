// Whether the poses can tell the parameters apart, asked before any fit: numbers that are none, too few or
// repeated poses, dead measurements, missing rotation, and the rank of each strut's Jacobian by its singular
// values. A singular value that the measurement noise alone would make counts as 0: noise turns a platform
// that never turned, too.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/problem.h"

namespace understudy::calibration {

struct Identifiability {
  Status status = Status::ok;
  std::string message;              ///< what is missing and what to do; empty when ok
  std::optional<std::size_t> pose;  ///< index of the sample at fault, where it is one
  std::vector<std::string> warnings;
  kinematics::PerStrut<int> strut_rank{};  ///< of strut_unknowns; 0 where it did not come so far
  int strut_unknowns = 0;                  ///< 7, and 1 more for each of dev and play
  int rank = 0;                            ///< of Unknowns::count(): dev is one unknown of all struts
  double condition = 0;                    ///< largest of the struts': ratio of singular values
};

Identifiability check_identifiability(const Problem& problem, const Unknowns& unknowns);

/// The nominal machine; with an unknown dev, at least 1 mm of it, for at 0 the lengths do not feel it.
HexapodParameters search_start(const Problem& problem, const Unknowns& unknowns);

// The parts, each empty when all is well; `message` says why not.

/// Finite numbers, rigid poses, positive definite covariances, struts longer than dev.
Fault input_fault(const Problem& problem);
/// A strut's displacement or a coordinate of the tip that stays within its noise over all poses.
std::string dead_measurement(const Problem& problem);
/// Orientations that stay within their noise, or turn about one axis only.
std::string missing_rotation(const Problem& problem);

}  // namespace understudy::calibration
