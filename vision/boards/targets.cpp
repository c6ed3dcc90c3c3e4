#include "vision/boards/targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "vision/boards/target_outline.h"
#include "vision/dot/grey_levels.h"

namespace understudy::vision {
namespace {

cv::Mat as_matrix(const Image& image) {
  return {image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.pixels.data())};
}

void check(const TargetOptions& options) {
  const auto need = [](bool good, const char* quantity, double value, const char* limit) {
    if (!good) {
      throw InputError(std::string("targets: ") + quantity + " is " + std::to_string(value) + ", must be " +
                       limit);
    }
  };
  need(options.camera.focal_px > 0, "focal length [px]", options.camera.focal_px, "positive");
  need(options.radius_px >= 8, "expected radius [px]", options.radius_px, "8 or more");
  need(options.search_px > 0, "search distance [px]", options.search_px, "positive");
}

/// Bleeding light can swallow a target, so a missing one in a white picture is overexposed.
TargetStatus why_missing(const GreyLevels& levels, const TargetOptions& options) {
  if (levels.saturated_fraction > options.saturated_fraction_max) return TargetStatus::overexposed;
  return levels.bright - levels.dark < options.contrast_min ? TargetStatus::low_contrast
                                                            : TargetStatus::missing;
}

}  // namespace

const char* to_string(TargetStatus s) {
  switch (s) {
    case TargetStatus::ok:
      return "ok";
    case TargetStatus::missing:
      return "the target is not where it is expected";
    case TargetStatus::partly_hidden:
      return "the target is partly hidden";
    case TargetStatus::clipped_by_border:
      return "the target reaches the picture's edge";
    case TargetStatus::overexposed:
      return "the target's picture is overexposed";
    case TargetStatus::low_contrast:
      return "the targets' picture has too little contrast";
    case TargetStatus::ambiguous:
      return "it is not clear which target is which";
  }
  return "unknown";
}

std::vector<Blob> find_dark_blobs(const Image& image, double radius_px) {
  const cv::Mat picture = as_matrix(image);
  cv::Mat mask, labels, stats, centres;
  cv::threshold(picture, mask, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8, CV_32S);
  const double expected = std::numbers::pi * radius_px * radius_px;
  std::vector<Blob> blobs;
  for (int i = 1; i < count; ++i) {
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area < 0.4 * expected || area > 2 * expected) continue;
    const int left = stats.at<int>(i, cv::CC_STAT_LEFT), top = stats.at<int>(i, cv::CC_STAT_TOP);
    const int right = left + stats.at<int>(i, cv::CC_STAT_WIDTH);
    const int bottom = top + stats.at<int>(i, cv::CC_STAT_HEIGHT);
    blobs.push_back({Vec2(centres.at<double>(i, 0), centres.at<double>(i, 1)),
                     std::sqrt(area / std::numbers::pi),
                     left <= 1 || top <= 1 || right >= picture.cols - 1 || bottom >= picture.rows - 1});
  }
  return blobs;
}

Vec2 moment_centre(const Image& image, const Vec2& near_px, double radius_px) {
  const Vec2 corner(image.region.x, image.region.y);
  Vec2 best = near_px;
  double nearest = 2 * radius_px;
  if (!has_pixels(image)) return best;
  for (const Blob& blob : find_dark_blobs(image, radius_px)) {
    const double distance = (blob.centre + corner - near_px).norm();
    if (distance < nearest) nearest = distance, best = blob.centre + corner;
  }
  return best;
}

TargetsMeasurement measure_targets(const Image& image, const std::array<Vec2, 3>& expected_px,
                                   const TargetOptions& options) {
  check(options);
  TargetsMeasurement result;
  std::array<int, 3> claims{};
  std::array<Blob, 3> claimed;
  GreyLevels levels;
  if (has_pixels(image)) {
    cv::setNumThreads(1);
    levels = grey_levels(image);
    const Vec2 corner(image.region.x, image.region.y);
    const bool contrast = levels.bright - levels.dark >= options.contrast_min;
    for (const Blob& blob : contrast ? find_dark_blobs(image, options.radius_px) : std::vector<Blob>{}) {
      for (std::size_t k = 0; k < 3; ++k) {
        if ((blob.centre + corner - expected_px[k]).norm() > options.search_px) continue;
        ++claims[k];
        claimed[k] = blob;
      }
    }
  }
  result.status = TargetStatus::ok;
  for (std::size_t k = 0; k < 3; ++k) {
    TargetMeasurement& m = result.targets[k];
    bool shared = claims[k] > 1;
    for (std::size_t j = 0; j < 3 && claims[k] > 0; ++j) {
      shared = shared || (j != k && claims[j] > 0 && claimed[j].centre == claimed[k].centre);
    }
    if (claims[k] == 0) {
      m.status = why_missing(levels, options);
    } else if (shared) {
      m.status = TargetStatus::ambiguous;
    } else {
      m = measure_outline(image, claimed[k], options);
      m.contrast = levels.bright - levels.dark;
    }
    if (m.status != TargetStatus::ok && result.status == TargetStatus::ok) {
      result.status = m.status;
      result.failed_target = static_cast<int>(k);
    }
  }
  return result;
}

}  // namespace understudy::vision
