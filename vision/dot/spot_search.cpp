#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

// A spot of expected size answers with 0.44 of its height.
constexpr double kFaintest = 0.25;   // response, of the contrast asked for
constexpr double kBlobLevel = 0.25;  // of the strongest response: what stands out
constexpr double kSizeLevel = 0.5;   // of a blob's own peak: where its size is taken
constexpr double kSameSize = 0.25;   // sizes that differ by less are equal; the brighter blob wins

/// Smoothed to the spot's own size, less the surroundings at four times that size.
cv::Mat spot_response(const Image& image, double expected_radius) {
  cv::Mat grey(image.height(), image.width(), CV_32F);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) grey.at<float>(y, x) = static_cast<float>(image.at(x, y));
  }
  const double sigma = std::max(0.5, expected_radius / 2);
  cv::Mat fine, coarse;
  cv::GaussianBlur(grey, fine, cv::Size(), sigma, sigma, cv::BORDER_REPLICATE);
  cv::GaussianBlur(grey, coarse, cv::Size(), 4 * sigma, 4 * sigma, cv::BORDER_REPLICATE);
  return fine - coarse;
}

struct Speck {
  double misfit = 0;  // of its size
  double light = 0;
  Vec2 centre{0, 0};

  bool better_than(const Speck& other) const {
    if (std::abs(misfit - other.misfit) > kSameSize) return misfit < other.misfit;
    return light > other.light;
  }
};

std::vector<Speck> blobs_above(const cv::Mat& response, double level, double expected_radius) {
  const cv::Mat mask = response > level;
  cv::Mat labels;
  const int count = cv::connectedComponents(mask, labels, 8, CV_32S);
  std::vector<Speck> blobs(static_cast<std::size_t>(std::max(0, count - 1)));
  std::vector<double> peak(blobs.size(), 0.0), area(blobs.size(), 0.0);
  const auto for_pixels = [&](const auto& visit) {
    for (int y = 0; y < labels.rows; ++y) {
      for (int x = 0; x < labels.cols; ++x) {
        const int label = labels.at<int>(y, x);
        if (label > 0)
          visit(static_cast<std::size_t>(label - 1), x, y, static_cast<double>(response.at<float>(y, x)));
      }
    }
  };
  for_pixels([&](std::size_t i, int x, int y, double light) {
    blobs[i].light += light;
    blobs[i].centre += light * Vec2(x, y);
    peak[i] = std::max(peak[i], light);
  });
  for_pixels([&](std::size_t i, int, int, double light) { area[i] += light > kSizeLevel * peak[i] ? 1 : 0; });
  // Of a Gaussian of the expected size, smoothed as much again.
  const double expected_area = std::numbers::pi * expected_radius * expected_radius * -std::log(kSizeLevel);
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    blobs[i].centre /= blobs[i].light;
    blobs[i].misfit = 0.5 * std::abs(std::log(area[i] / expected_area));
  }
  return blobs;
}

}  // namespace

std::optional<SpotGuess> find_spot(const Image& image, const DotOptions& options) {
  const cv::Mat response = spot_response(image, options.expected_radius_px);
  double strongest = 0;
  cv::minMaxLoc(response, nullptr, &strongest);
  if (!(strongest > kFaintest * options.contrast_min)) return std::nullopt;
  const auto blobs = blobs_above(response, kBlobLevel * strongest, options.expected_radius_px);
  if (blobs.empty()) return std::nullopt;
  const Speck* best = &blobs.front();
  for (const Speck& blob : blobs) {
    if (blob.better_than(*best)) best = &blob;
  }
  return SpotGuess{best->centre};
}

}  // namespace understudy::vision
