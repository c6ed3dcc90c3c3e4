// Roughness parameters of a profile: ISO 4287, ISO 4288 and the Gaussian filter of ISO 16610-21.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace understudy::sim {

struct RoughnessSettings {
  std::optional<double> cutoff;        ///< lambda_c [m]; none: chosen as ISO 4288 does
  std::optional<double> short_cutoff;  ///< lambda_s [m]; none: the profile is not smoothed
};

struct Roughness {
  double ra = 0, rq = 0, rz = 0;   ///< [m], means over the sampling lengths
  std::optional<double> rsm;       ///< [m]; none without a whole profile element
  double cutoff = 0;               ///< [m], lambda_c, and the sampling length
  int sampling_lengths = 0;        ///< 5, or as many as the line has room for
  bool cutoff_is_standard = true;  ///< false: ISO 4288 asks for one that was not given or has no room
  double evaluation_from = 0, evaluation_length = 0;  ///< [m], along the profile
};

/// Heights [m] at equal pitch [m], form removed. At both ends half a cut-off is run-in: filtered, and not
/// evaluated. Throws InputError: heights that are not finite, a pitch or cut-off out of range, a cut-off
/// below ten pitches or above half the line, a line shorter than twice the smallest cut-off of ISO 4288 (0.08
/// mm).
Roughness roughness(std::span<const double> heights, double pitch, const RoughnessSettings& settings = {});

/// The waviness: what the Gaussian profile filter passes, half of it at a wavelength of `cutoff`. The
/// weighting function reaches one cut-off to both sides; where the profile ends earlier it is cut off and
/// its zeroth and first moments corrected, so that a straight line stays one up to its ends (ISO 16610-28).
std::vector<double> gaussian_mean_line(std::span<const double> heights, double pitch, double cutoff);

/// Roughness profile: heights less mean line, smoothed by lambda_s first.
std::vector<double> roughness_profile(std::span<const double> heights, double pitch, double cutoff,
                                      std::optional<double> short_cutoff = {});

}  // namespace understudy::sim
