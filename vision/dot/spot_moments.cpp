#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr double kWindow = 3;          // standard deviations: 1.1 % of a Gaussian lies outside
constexpr double kTightest = 2.2;      // where noise of the surroundings rules
constexpr double kSmallestWindow = 1;  // below, the moments of what is left say nothing
constexpr int kIterations = 60;

struct Pixels {
  std::vector<double> dx, dy, level;
};

/// Second moments of a Gaussian inside `window` standard deviations, as a fraction of the whole.
double truncated_variance(double window) {
  const double h = window * window / 2;
  return 1 - h * std::exp(-h) / (1 - std::exp(-h));
}

Eigen::Matrix2d limited(const Eigen::Matrix2d& spread, double expected_radius) {
  const double low = std::max(0.4, expected_radius / 8), high = 2.5 * expected_radius;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(0.5 * (spread + spread.transpose()));
  const Vec2 variances = solver.eigenvalues().cwiseMax(low * low).cwiseMin(high * high);
  return solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
}

/// Pixels of the elliptic ring around the window.
Pixels ring(const Image& image, const Spot& spot) {
  const Eigen::Matrix2d inverse = spot.spread.inverse();
  const double inner = kWindow + 0.8, outer = kWindow + 2.8;
  const int rx = static_cast<int>(std::ceil(outer * std::sqrt(spot.spread(0, 0))));
  const int ry = static_cast<int>(std::ceil(outer * std::sqrt(spot.spread(1, 1))));
  const int cx = static_cast<int>(std::lround(spot.centre.x())),
            cy = static_cast<int>(std::lround(spot.centre.y()));
  Pixels pixels;
  for (int y = std::max(0, cy - ry); y <= std::min(image.height() - 1, cy + ry); ++y) {
    for (int x = std::max(0, cx - rx); x <= std::min(image.width() - 1, cx + rx); ++x) {
      const double d = normalised_distance(spot, inverse, x, y);
      if (d < inner || d > outer) continue;
      pixels.dx.push_back(x - spot.centre.x());
      pixels.dy.push_back(y - spot.centre.y());
      pixels.level.push_back(image.at(x, y));
    }
  }
  return pixels;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Least-squares plane through the ring, twice without what stands off (another spot, the nozzle's edge).
std::optional<Surroundings> fit_plane(const Pixels& p) {
  if (p.level.size() < 24) return std::nullopt;
  Surroundings s;
  s.level = median(p.level);
  std::vector<double> off(p.level.size());
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < off.size(); ++i) {
      off[i] = std::abs(p.level[i] - s.level - s.slope.x() * p.dx[i] - s.slope.y() * p.dy[i]);
    }
    const double limit = std::max(1.5, 3.5 * 1.4826 * median(off));
    Mat3 normal = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    double used = 0, sum_squares = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (off[i] > limit) continue;
      const Vec3 row(1, p.dx[i], p.dy[i]);
      normal += row * row.transpose();
      right += row * p.level[i];
      sum_squares += p.level[i] * p.level[i];
      used += 1;
    }
    if (used < 24) return std::nullopt;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(normal / used, Eigen::EigenvaluesOnly);
    if (solver.eigenvalues()[0] < 0.05) return std::nullopt;  // all on one side: no plane to be had
    const Vec3 plane = normal.inverse() * right;
    s.level = plane.x();
    s.slope = plane.tail<2>();
    s.variance = std::max(0.0, (sum_squares - plane.dot(right)) / (used - 3));
    s.slope_covariance = s.variance * Mat3(normal.inverse()).bottomRightCorner<2, 2>();
  }
  return s;
}

/// A dim tenth of the picture, where the ring gives nothing.
Surroundings darkest(const Image& image) {
  std::vector<double> levels(image.pixels.begin(), image.pixels.end());
  const auto tenth = static_cast<std::ptrdiff_t>(levels.size() / 10);
  std::nth_element(levels.begin(), levels.begin() + tenth, levels.end());
  Surroundings s;
  s.level = levels[static_cast<std::size_t>(tenth)];
  s.variance = 1;
  return s;
}

/// Variance of the centroid of a Gaussian by the model of dot.h, per axis of a round spot of equal area
/// [px^2].
double expected_variance(const Spot& spot, double window, const DotOptions& options) {
  const double s2 = std::sqrt(spot.spread.determinant()), k2 = window * window;
  const double inside = 1 - std::exp(-k2 / 2), hold = truncated_variance(window);
  const double level = std::max(spot.around.variance, 1.0 / 12) * std::numbers::pi * k2 * k2 * s2 * s2 / 4;
  const double photons = options.grey_per_electron * spot.flux * s2 * inside * hold;
  const double grains = options.speckle_area_px2 * spot.flux * spot.flux / (8 * std::numbers::pi) *
                        (1 - (1 + k2) * std::exp(-k2));
  return (level + photons + grains) / std::pow(spot.flux * inside * hold, 2);
}

/// Speckle wants a wide window, a dim spot on a noisy ground a tight one.
double best_window(const Spot& spot, const DotOptions& options) {
  if (options.speckle_area_px2 < 0) return kWindow;
  double best = kWindow;
  for (double window = kWindow - 0.2; window > kTightest - 0.1; window -= 0.2) {
    if (expected_variance(spot, window, options) < expected_variance(spot, best, options)) best = window;
  }
  return best;
}

double window_inside(const Image& image, const Spot& spot, double wanted) {
  const double x = std::min(spot.centre.x() + 0.5, image.width() - 0.5 - spot.centre.x());
  const double y = std::min(spot.centre.y() + 0.5, image.height() - 0.5 - spot.centre.y());
  // Half a pixel for the soft edge.
  const double fits =
      std::min((x - 0.5) / std::sqrt(spot.spread(0, 0)), (y - 0.5) / std::sqrt(spot.spread(1, 1)));
  return std::clamp(fits, kSmallestWindow, wanted);
}

struct Sums {
  double flux = 0;
  Vec2 first{0, 0};
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
};

Sums sum_window(const Image& image, const Spot& spot) {
  const Eigen::Matrix2d inverse = spot.spread.inverse();
  const int rx = static_cast<int>(std::ceil(spot.window * std::sqrt(spot.spread(0, 0)))) + 1;
  const int ry = static_cast<int>(std::ceil(spot.window * std::sqrt(spot.spread(1, 1)))) + 1;
  const int cx = static_cast<int>(std::lround(spot.centre.x())),
            cy = static_cast<int>(std::lround(spot.centre.y()));
  Sums sums;
  for (int y = std::max(0, cy - ry); y <= std::min(image.height() - 1, cy + ry); ++y) {
    for (int x = std::max(0, cx - rx); x <= std::min(image.width() - 1, cx + rx); ++x) {
      const Vec2 d(x - spot.centre.x(), y - spot.centre.y());
      const double weight = window_weight(normalised_distance(spot, inverse, x, y), d.norm(), spot.window);
      if (weight <= 0) continue;
      const double light = weight * (image.at(x, y) - spot.around.level - spot.around.slope.dot(d));
      sums.flux += light;
      sums.first += light * d;
      sums.second += light * d * d.transpose();
    }
  }
  return sums;
}

}  // namespace

double Spot::amplitude() const { return flux / (2 * std::numbers::pi * std::sqrt(spread.determinant())); }

double normalised_distance(const Spot& spot, const Eigen::Matrix2d& inverse_spread, double x, double y) {
  const Vec2 d(x - spot.centre.x(), y - spot.centre.y());
  return std::sqrt(d.dot(inverse_spread * d));
}

double window_weight(double distance_sigmas, double distance_px, double window) {
  if (distance_px <= 0) return 1;
  const double inside_px = (window - distance_sigmas) * distance_px / distance_sigmas;
  return std::clamp(inside_px + 0.5, 0.0, 1.0);
}

std::optional<Spot> measure_moments(const Image& image, const SpotGuess& guess, const DotOptions& options) {
  Spot spot;
  spot.centre = guess.centre;
  const double sigma = options.expected_radius_px / 2;
  spot.spread = Eigen::Matrix2d::Identity() * (1.5 * 1.5 * sigma * sigma);
  double wanted = kWindow;
  for (int i = 0; i < kIterations && !spot.converged; ++i) {
    if (i > 2 && i < 8) wanted = best_window(spot, options);  // then fixed, so that the rest converges
    spot.window = window_inside(image, spot, wanted);
    const auto plane = fit_plane(ring(image, spot));
    spot.around = plane ? *plane : darkest(image);
    const Sums sums = sum_window(image, spot);
    if (!(sums.flux > 0)) return std::nullopt;
    const Vec2 step = sums.first / sums.flux;
    const Eigen::Matrix2d spread =
        limited((sums.second / sums.flux - step * step.transpose()) / truncated_variance(spot.window),
                options.expected_radius_px);
    spot.converged = i > 4 && step.norm() < 1e-4 && (spread - spot.spread).norm() < 1e-3 * spot.spread.norm();
    spot.centre += step;
    spot.centre =
        spot.centre.cwiseMax(Vec2(-0.5, -0.5)).cwiseMin(Vec2(image.width() - 0.5, image.height() - 0.5));
    spot.spread = spread;
    spot.flux = sums.flux / (1 - std::exp(-spot.window * spot.window / 2));
  }
  return spot;
}

}  // namespace understudy::vision
