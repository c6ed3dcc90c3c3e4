#include "vision/dot/dot.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr double kWindowNeeded = 2;  // standard deviations: the 1/e^2 ellipse lies inside the picture
constexpr double kLongest = 8;       // axis ratio; a laser at 80 degrees from the normal draws 6
constexpr double kSmallest = 0.3, kLargest = 4;  // of the expected radius

bool usable(const Image& image, const DotOptions& options) {
  return image.width() >= 5 && image.height() >= 5 && options.expected_radius_px > 0 &&
         std::isfinite(options.expected_radius_px) &&
         image.pixels.size() ==
             static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

bool all_white(const Image& image) {
  const auto white = std::count(image.pixels.begin(), image.pixels.end(), std::uint8_t{255});
  return 2 * static_cast<std::size_t>(white) > image.pixels.size();
}

double saturated_fraction(const Image& image, const Spot& spot) {
  const Eigen::Matrix2d inverse = spot.spread.inverse();
  int inside = 0, saturated = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (normalised_distance(spot, inverse, x, y) > 2) continue;
      ++inside;
      if (image.at(x, y) == 255) ++saturated;
    }
  }
  return inside > 0 ? static_cast<double>(saturated) / inside : 0;
}

DotStatus judge(const DotMeasurement& m, const Spot& spot, const DotOptions& options) {
  if (!(m.contrast >= options.contrast_min)) return DotStatus::no_dot;
  if (spot.window < kWindowNeeded) return DotStatus::clipped_by_border;
  if (m.saturated_fraction > options.saturated_fraction_max) return DotStatus::saturated;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spot.spread, Eigen::EigenvaluesOnly);
  const double ratio = std::sqrt(solver.eigenvalues()[1] / solver.eigenvalues()[0]);
  const bool size_fits = m.radius_px > kSmallest * options.expected_radius_px &&
                         m.radius_px < kLargest * options.expected_radius_px;
  if (ratio > kLongest || !size_fits) return DotStatus::not_a_spot;
  if (!m.covariance_px2.allFinite() || !m.position_px.allFinite()) return DotStatus::not_a_spot;
  return DotStatus::ok;
}

}  // namespace

const char* to_string(DotStatus s) {
  switch (s) {
    case DotStatus::ok:
      return "ok";
    case DotStatus::no_dot:
      return "no dot";
    case DotStatus::saturated:
      return "saturated";
    case DotStatus::clipped_by_border:
      return "clipped by the border";
    case DotStatus::not_a_spot:
      return "not a spot";
  }
  return "unknown";
}

DotOptions dot_options(const DotOptics& optics) {
  DotOptions options;
  options.expected_radius_px =
      std::hypot(optics.waist_diameter / 2 * optics.px_per_metre, 2 * optics.blur_px);
  options.grey_per_electron = 255 / optics.full_well;
  options.speckle_area_px2 = speckle_area_px2(optics.wavelength, optics.aperture_sine, optics.px_per_metre);
  return options;
}

DotMeasurement measure_dot(const Image& image, const DotOptions& options) {
  DotMeasurement m;
  if (!usable(image, options)) return m;
  if (all_white(image)) {
    m.status = DotStatus::saturated;
    m.saturated_fraction = 1;
    return m;
  }
  const auto guess = find_spot(image, options);
  if (!guess) return m;
  const auto spot = measure_moments(image, *guess, options);
  if (!spot) return m;
  m.position_px = spot->centre + Vec2(image.region.x, image.region.y);
  const SpotScatter scatter = spot_scatter(image, *spot, options);
  m.covariance_px2 = scatter.centroid;
  m.spread_px2 = spot->spread;
  m.spread_sigma = scatter.spread;
  m.contrast = spot->amplitude();
  m.radius_px = 2 * std::pow(spot->spread.determinant(), 0.25);
  m.saturated_fraction = saturated_fraction(image, *spot);
  m.status = judge(m, *spot, options);
  return m;
}

}  // namespace understudy::vision
