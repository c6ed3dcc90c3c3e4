#include "vision/boards/target_outline.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "vision/boards/lens_distortion.h"
#include "vision/dot/grey_levels.h"

namespace understudy::vision {
namespace {

constexpr int kRays = 180;  // one each 2 px of the default outline: edges of neighbours hardly share pixels
constexpr double kStep = 0.5;         // [px] along a ray
constexpr double kReach = 3;          // [px] on each side of an edge that belong to it: four blurs of 0.7 px
constexpr double kSystematic = 0.01;  // [px]: what is left without noise, from 8 bits and shading (tests)

struct Edge {
  double angle = 0;
  Vec2 at{0, 0};
};

double bilinear(const Image& image, double x, double y) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * image.at(i, j) + a * image.at(i + 1, j)) +
         b * ((1 - a) * image.at(i, j + 1) + a * image.at(i + 1, j + 1));
}

double mean_over(const std::vector<double>& levels, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += levels[i];
  return sum / static_cast<double>(to - from);
}

/// Radius at which a ray leaves the blob: first the crossing of the middle level, then the place of an ideal
/// step that has as much light over the stretch around it, which uses all of its pixels.
std::optional<double> edge_on_ray(const Image& image, const Blob& blob, double angle, double contrast_min) {
  const double first = 0.75 * blob.radius, last = 1.25 * blob.radius;
  const auto count = static_cast<std::size_t>((last - first) / kStep);
  std::vector<double> levels(count);
  const Vec2 direction(std::cos(angle), std::sin(angle));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 p = blob.centre + (first + kStep * static_cast<double>(i)) * direction;
    if (p.x() < 0 || p.y() < 0 || p.x() >= image.width() - 1 || p.y() >= image.height() - 1)
      return std::nullopt;
    levels[i] = bilinear(image, p.x(), p.y());
  }
  const double coarse_middle =
      0.5 * (mean_over(levels, 0, count / 4) + mean_over(levels, 3 * count / 4, count));
  std::size_t crossing = 0;
  while (crossing < count && levels[crossing] < coarse_middle) ++crossing;
  const auto reach = static_cast<std::size_t>(kReach / kStep);
  if (crossing < 2 * reach || crossing + 2 * reach > count) return std::nullopt;
  const double inside = mean_over(levels, crossing - 2 * reach, crossing - reach);
  const double outside = mean_over(levels, crossing + reach, crossing + 2 * reach);
  if (!(outside - inside > contrast_min)) return std::nullopt;
  double dark = 0;  // samples that an ideal step would have on its dark side
  for (std::size_t i = crossing - reach; i < crossing + reach; ++i) {
    dark += (outside - levels[i]) / (outside - inside);
  }
  return first + kStep * (static_cast<double>(crossing - reach) - 0.5 + dark);
}

struct Ellipse {
  Vec2 centre{0, 0};
  Vec2 half{0, 0};  // along its axes
  double turn = 0;  // of the first axis

  double half_width_along(const Vec2& direction) const {
    const double c = std::cos(turn), s = std::sin(turn);
    const double a = half.x() * (c * direction.x() + s * direction.y()),
                 b = half.y() * (-s * direction.x() + c * direction.y());
    return std::sqrt(a * a + b * b);
  }
  /// Distance of a point outside, to the first order.
  double residual(const Vec2& p) const {
    const double c = std::cos(turn), s = std::sin(turn);
    const Vec2 d = p - centre, local(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
    const Vec2 scaled = local.cwiseQuotient(half);
    const double level = scaled.norm();
    return level > 0 ? (level - 1) * level / scaled.cwiseQuotient(half).norm() : -half.minCoeff();
  }
};

std::optional<Ellipse> fit(const std::vector<Edge>& edges, const Vec2& about) {
  if (edges.size() < 12) return std::nullopt;
  std::vector<cv::Point2f> points;
  for (const Edge& e : edges) {
    points.emplace_back(static_cast<float>(e.at.x() - about.x()), static_cast<float>(e.at.y() - about.y()));
  }
  const cv::RotatedRect box = cv::fitEllipseDirect(points);
  const Ellipse ellipse{
      about + Vec2(box.center.x, box.center.y),
      Vec2(0.5 * static_cast<double>(box.size.width), 0.5 * static_cast<double>(box.size.height)),
      static_cast<double>(box.angle) * std::numbers::pi / 180};
  const bool good = ellipse.centre.allFinite() && ellipse.half.minCoeff() > 1 && std::isfinite(ellipse.turn);
  return good ? std::optional(ellipse) : std::nullopt;
}

double spread(const std::vector<Edge>& edges, const Ellipse& ellipse) {
  std::vector<double> sizes;
  for (const Edge& e : edges) sizes.push_back(std::abs(ellipse.residual(e.at)));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 1.4826 * *middle;  // of a Gaussian
}

/// Fits, drops what is off by more than four sigma (at least 0.15 px), fits again.
std::optional<Ellipse> fit_without_outliers(std::vector<Edge>& edges, const Vec2& about) {
  const std::vector<Edge> all = edges;
  std::optional<Ellipse> ellipse = fit(edges, about);
  for (int round = 0; round < 6 && ellipse; ++round) {
    const double limit = std::max(0.15, 4 * spread(edges, *ellipse));
    std::vector<Edge> kept;
    for (const Edge& e : all) {
      if (std::abs(ellipse->residual(e.at)) < limit) kept.push_back(e);
    }
    const bool same = kept.size() == edges.size();
    edges = kept;
    ellipse = fit(edges, about);
    if (same) break;
  }
  return ellipse;
}

/// A step of the edge along its normal moves centre, size and the two parameters of ellipticity.
Eigen::Matrix2d centre_covariance(const std::vector<Edge>& edges, double variance) {
  Eigen::Matrix<double, 5, 5> information = Eigen::Matrix<double, 5, 5>::Zero();
  for (const Edge& e : edges) {
    const double c = std::cos(e.angle), s = std::sin(e.angle);
    Eigen::Matrix<double, 5, 1> row;
    row << c, s, 1, c * c - s * s, 2 * c * s;
    information += row * row.transpose();
  }
  return variance * information.inverse().topLeftCorner<2, 2>() +
         kSystematic * kSystematic * Eigen::Matrix2d::Identity();
}

double saturated_around(const Image& image, const Blob& blob) {
  int saturated = 0, count = 0;
  const double reach = 1.3 * blob.radius;
  for (int y = std::max(0, static_cast<int>(blob.centre.y() - reach));
       y < std::min(image.height(), static_cast<int>(blob.centre.y() + reach)); ++y) {
    for (int x = std::max(0, static_cast<int>(blob.centre.x() - reach));
         x < std::min(image.width(), static_cast<int>(blob.centre.x() + reach)); ++x) {
      ++count;
      if (image.at(x, y) == 255) ++saturated;
    }
  }
  return count > 0 ? static_cast<double>(saturated) / count : 0;
}

}  // namespace

TargetMeasurement measure_outline(const Image& image, const Blob& blob, const TargetOptions& options) {
  TargetMeasurement m;
  m.radius_px = blob.radius;
  if (blob.at_border) {
    m.status = TargetStatus::clipped_by_border;
    return m;
  }
  if (saturated_around(image, blob) > options.saturated_fraction_max) {
    m.status = TargetStatus::overexposed;
    return m;
  }
  std::vector<Edge> edges;
  const Vec2 corner(image.region.x, image.region.y);
  for (int k = 0; k < kRays; ++k) {
    const double angle = 2 * std::numbers::pi * k / kRays;
    const auto radius = edge_on_ray(image, blob, angle, 0.5 * options.contrast_min);
    if (!radius) continue;
    const Vec2 seen = corner + blob.centre + *radius * Vec2(std::cos(angle), std::sin(angle));
    edges.push_back({angle, without_distortion(options.camera, seen)});
  }
  const auto ellipse = fit_without_outliers(edges, without_distortion(options.camera, corner + blob.centre));
  const auto lost = kRays - static_cast<int>(edges.size());
  if (!ellipse || lost > options.hidden_fraction_max * kRays ||
      ellipse->half.minCoeff() < 0.9 * ellipse->half.maxCoeff()) {
    m.status = TargetStatus::partly_hidden;
    return m;
  }
  double squares = 0;
  for (const Edge& e : edges) squares += std::pow(ellipse->residual(e.at), 2);
  const double variance = squares / (static_cast<double>(edges.size()) - 5);
  const Vec2 from_axis = ellipse->centre - options.camera.centre_px;
  const Vec2 across = from_axis.norm() > 1 ? Vec2(-from_axis.y(), from_axis.x()).normalized() : Vec2(1, 0);
  m.radius_px = ellipse->half_width_along(across);
  const double q = std::pow(m.radius_px / options.camera.focal_px, 2);
  m.centre_px = with_distortion(options.camera, Vec2(options.camera.centre_px + from_axis / (1 + q)));
  m.outline_px = with_distortion(options.camera, ellipse->centre);
  m.edge_scatter_px = std::sqrt(variance);
  m.covariance_px2 = centre_covariance(edges, variance);
  m.status = m.centre_px.allFinite() && m.covariance_px2.allFinite() ? TargetStatus::ok
                                                                     : TargetStatus::partly_hidden;
  return m;
}

}  // namespace understudy::vision
