// Sub-pixel position of the laser dot in a grey image, with covariance (Song 2015, 3.3;
// docs/reference.md#dot-and-gap).
#pragma once

#include "core/image.h"

namespace understudy::vision {

enum class DotStatus { ok, no_dot, saturated, clipped_by_border, not_a_spot };
const char* to_string(DotStatus s);

struct DotOptions {
  double expected_radius_px = 5;             ///< 1/e^2 radius of the spot in the image
  double saturated_fraction_max = 0.02;      ///< of the spot's pixels at 255
  double contrast_min = 12;                  ///< grey levels of the spot over its surroundings
  double grey_per_electron = 255.0 / 10000;  ///< of the sensor: 255 / full well; scales shot noise
  /// Correlation area of the speckle [px^2], see speckle_area_px2(); 0: the light is incoherent; negative:
  /// estimated from the spot's own graininess, which scatters much: give it when the optics are known.
  double speckle_area_px2 = -1;
};

/// Laser and microscope, as far as they shape the dot.
struct DotOptics {
  double px_per_metre = 0;    ///< at the dot
  double waist_diameter = 0;  ///< [m], 1/e^2
  double wavelength = 0;      ///< [m]
  double aperture_sine = 0;   ///< sin u on the object side
  double blur_px = 0;         ///< 1 sigma
  double full_well = 0;       ///< [electrons] at 255 grey levels
};

/// What to look for in their pictures.
DotOptions dot_options(const DotOptics& optics);

struct DotMeasurement {
  DotStatus status = DotStatus::no_dot;
  Vec2 position_px{0, 0};  ///< on the sensor (the image's region is added)
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d spread_px2 = Eigen::Matrix2d::Zero();  ///< second central moments, of an uncut Gaussian
  double spread_sigma = 0;                               ///< of those, along any direction: a share of them
  double contrast = 0;   ///< grey levels, peak of the Gaussian of equal flux and extent
  double radius_px = 0;  ///< 1/e^2, geometric mean of both axes
  double saturated_fraction = 0;
};

/// Correlation area of fully developed speckle seen through a round aperture [px^2].
double speckle_area_px2(double wavelength, double aperture_sine, double px_per_metre);

/// Weighted centroid above the surroundings: under speckle it beats a Gaussian fit. Never throws.
/// The covariance is that of sum(w I x) / sum(w I), w the window, I above the surroundings, M its Gaussian:
///   sum w^2 (v + g M) d d^T / F^2   noise: v as found around the spot, g M that of the photons;
///                                   and the uncertainty of the slope of the surroundings, which
///                                   is subtracted
///   + A sum w^2 M^2 d d^T / F^2     speckle of correlation area A: A / (8 pi) on a round spot of any size
/// each over the square of the share in which the window holds on to the centre (0.95 at 3 sigma). It leaves
/// out the offset between the centroid and the beam's axis on curved or oblique surfaces.
DotMeasurement measure_dot(const Image& image, const DotOptions& options);

/// The same dot by a least-squares fit of an elliptic Gaussian on a level ground, for comparison: dearer, and
/// worse under speckle (docs/reference.md#dot-and-gap). Its covariance takes the residuals as independent
/// from grain to grain.
DotMeasurement fit_dot(const Image& image, const DotOptions& options);

}  // namespace understudy::vision
