#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/dot/dot.h"
#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr double kHalfWidth = 3;     // standard deviations, fitted around the centroid
constexpr int kIterations = 40;      // Levenberg-Marquardt from the moments: some 8
constexpr double kConverged = 1e-5;  // [px], a hundredth of the noise of the best picture
constexpr double kDampingMax = 1e9;  // no step lowers the residual any more

/// level + amplitude exp(-1/2 d^T W d), W = [a b; b c] the inverse of the spread.
using Parameters = Eigen::Matrix<double, 7, 1>;  // level, amplitude, x, y, a, b, c
using Normal = Eigen::Matrix<double, 7, 7>;

struct Window {
  int x0, x1, y0, y1;
  double pixels() const { return static_cast<double>(x1 - x0 + 1) * (y1 - y0 + 1); }
};

Window window_around(const Image& image, const Spot& spot) {
  const int rx = static_cast<int>(std::ceil(kHalfWidth * std::sqrt(spot.spread(0, 0))));
  const int ry = static_cast<int>(std::ceil(kHalfWidth * std::sqrt(spot.spread(1, 1))));
  const int cx = static_cast<int>(std::lround(spot.centre.x()));
  const int cy = static_cast<int>(std::lround(spot.centre.y()));
  return {std::max(0, cx - rx), std::min(image.width() - 1, cx + rx), std::max(0, cy - ry),
          std::min(image.height() - 1, cy + ry)};
}

/// Sum of squares, and the normal equations where they are asked for.
double residuals(const Image& image, const Window& w, const Parameters& p, Normal* normal,
                 Parameters* right) {
  if (normal) normal->setZero();
  if (right) right->setZero();
  double squares = 0;
  for (int y = w.y0; y <= w.y1; ++y)
    for (int x = w.x0; x <= w.x1; ++x) {
      const double dx = x - p[2], dy = y - p[3];
      const double bell = std::exp(-0.5 * (p[4] * dx * dx + 2 * p[5] * dx * dy + p[6] * dy * dy));
      const double miss = image.at(x, y) - p[0] - p[1] * bell;
      squares += miss * miss;
      if (!normal) continue;
      const double light = p[1] * bell;
      Parameters row;
      row << 1, bell, light * (p[4] * dx + p[5] * dy), light * (p[5] * dx + p[6] * dy),
          -0.5 * light * dx * dx, -light * dx * dy, -0.5 * light * dy * dy;
      *normal += row * row.transpose();
      *right += row * miss;
    }
  return squares;
}

bool usable(const Parameters& p) {
  return p.allFinite() && p[4] > 0 && p[6] > 0 && p[4] * p[6] > p[5] * p[5];
}

/// False: it did not come to rest.
bool fit(const Image& image, const Window& window, Parameters& p, Normal& normal, double& squares) {
  Parameters right;
  double damping = 1e-3;
  squares = residuals(image, window, p, &normal, &right);
  for (int i = 0; i < kIterations && damping < kDampingMax; ++i) {
    Normal damped = normal;
    damped.diagonal() *= 1 + damping;
    const Parameters step = damped.ldlt().solve(right);
    const Parameters next = p + step;
    const double lower = usable(next) ? residuals(image, window, next, nullptr, nullptr) : squares;
    if (!(lower < squares)) {
      if (step.segment<2>(2).norm() < kConverged) return true;
      damping *= 10;
      continue;
    }
    p = next;
    damping *= 0.3;
    squares = residuals(image, window, p, &normal, &right);
    if (step.segment<2>(2).norm() < kConverged) return true;
  }
  return false;
}

}  // namespace

DotMeasurement fit_dot(const Image& image, const DotOptions& options) {
  DotMeasurement m = measure_dot(image, options);
  if (m.status != DotStatus::ok) return m;
  const auto guess = find_spot(image, options);
  const auto spot = guess ? measure_moments(image, *guess, options) : std::nullopt;
  if (!spot) return m;
  const Eigen::Matrix2d inverse = spot->spread.inverse();
  Parameters p;
  p << spot->around.level, spot->amplitude(), spot->centre, inverse(0, 0), inverse(0, 1), inverse(1, 1);
  const Window window = window_around(image, *spot);
  Normal normal;
  double squares = 0;
  if (window.pixels() < 25 || !fit(image, window, p, normal, squares)) {
    m.status = DotStatus::not_a_spot;
    return m;
  }
  m.position_px = p.segment<2>(2) + Vec2(image.region.x, image.region.y);
  m.radius_px = 2 * std::pow(p[4] * p[6] - p[5] * p[5], -0.25);
  m.contrast = p[1];
  const double variance = squares / (window.pixels() - 7) * std::max(1.0, options.speckle_area_px2);
  m.covariance_px2 = variance * Normal(normal.inverse()).block<2, 2>(2, 2);
  if (!m.position_px.allFinite() || !m.covariance_px2.allFinite()) m.status = DotStatus::not_a_spot;
  return m;
}

}  // namespace understudy::vision
