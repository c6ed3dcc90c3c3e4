// Private to this room: the stages between a grey picture and a measured dot.
#pragma once

#include <optional>
#include <vector>

#include "vision/dot/dot.h"

namespace understudy::vision {

/// Where a spot probably is, in pixels of the image (its region not added).
struct SpotGuess {
  Vec2 centre{0, 0};
};

/// The blob of nearly the expected size that stands out of its surroundings; nothing when none does.
std::optional<SpotGuess> find_spot(const Image& image, const DotOptions& options);

/// A plane of grey levels under the spot, and the scatter about it.
struct Surroundings {
  double level = 0;     ///< grey levels at the spot's centre
  Vec2 slope{0, 0};     ///< grey levels per px
  double variance = 0;  ///< of a pixel about the plane
  Eigen::Matrix2d slope_covariance = Eigen::Matrix2d::Zero();
};

/// The spot as a Gaussian of equal moments, in pixels of the image.
struct Spot {
  Vec2 centre{0, 0};
  Eigen::Matrix2d spread = Eigen::Matrix2d::Identity();  ///< [px^2], second central moments
  double flux = 0;                                       ///< grey levels x px
  double window = 0;                                     ///< half-width of the window, in standard deviations
  Surroundings around;
  bool converged = false;

  double amplitude() const;
};

/// Moments in an elliptic window that is centred on its own centroid, so that it cuts nothing off one side;
/// near the border it shrinks on both sides alike. Nothing when there is no light in the window.
std::optional<Spot> measure_moments(const Image& image, const SpotGuess& guess, const DotOptions& options);

/// Distance from the spot's centre in standard deviations.
double normalised_distance(const Spot& spot, const Eigen::Matrix2d& inverse_spread, double x, double y);
/// 1 inside the window, 0 outside, falling over one pixel at its edge.
double window_weight(double distance_sigmas, double distance_px, double window);

struct SpotScatter {
  Eigen::Matrix2d centroid = Eigen::Matrix2d::Zero();  ///< [px^2]
  double spread = 0;                                   ///< 1 sigma of a second moment, a share of it
};

/// How much the spot's moments scatter; the model is stated in dot.h.
SpotScatter spot_scatter(const Image& image, const Spot& spot, const DotOptions& options);

}  // namespace understudy::vision
