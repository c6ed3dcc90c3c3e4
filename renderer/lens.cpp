#include "renderer/lens.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/brown_model.h"

namespace understudy::renderer {
namespace {

/// Newton on Brown's model from the ray of a pixel near by. Where the model folds over, beyond what a real
/// lens does, the last step stands.
Vec2 undistort(const Camera& camera, const Vec2& pixel, Vec2 ray) {
  const Vec2 wanted = (pixel - camera.centre_px) / camera.focal_px;
  const double close_enough = 1e-9 / camera.focal_px;
  for (int i = 0; i < 20; ++i) {
    const DistortedRay seen = distort(camera, ray);
    const Vec2 error = seen.ray - wanted;
    if (error.norm() < close_enough) break;
    ray -= seen.slopes.inverse() * error;
  }
  return ray;
}

bool has_distortion(const Camera& c) { return c.k1 != 0 || c.k2 != 0 || c.p1 != 0 || c.p2 != 0; }

}  // namespace

Lens::Lens(const Camera& camera, int margin) : camera_(camera), margin_(margin) {
  width_ = kSamplesPerPixel * (camera.width + 2 * margin);
  height_ = kSamplesPerPixel * (camera.height + 2 * margin);
  if (!has_distortion(camera)) return;
  ideal_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const int first = -kSamplesPerPixel * margin;
  for (int j = first; j < first + height_; ++j) {
    for (int i = first; i < first + width_; ++i) {
      const Vec2 pixel(pixel_of_sample(i), pixel_of_sample(j));
      const Vec2 near = i == first ? Vec2((pixel - camera.centre_px) / camera.focal_px) : ideal_.back();
      ideal_.push_back(undistort(camera, pixel, near));
    }
  }
}

bool Lens::matches(const Camera& c, int margin) const {
  return margin == margin_ && c.width == camera_.width && c.height == camera_.height &&
         c.focal_px == camera_.focal_px && c.centre_px == camera_.centre_px && c.k1 == camera_.k1 &&
         c.k2 == camera_.k2 && c.p1 == camera_.p1 && c.p2 == camera_.p2;
}

Vec2 Lens::mapped(int i, int j) const {
  const int column = std::clamp(i + kSamplesPerPixel * margin_, 0, width_ - 1);
  const int row = std::clamp(j + kSamplesPerPixel * margin_, 0, height_ - 1);
  return ideal_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(column)];
}

Vec2 Lens::ray(double i, double j) const {
  if (!distorts()) {
    return (Vec2(pixel_of_sample(i), pixel_of_sample(j)) - camera_.centre_px) / camera_.focal_px;
  }
  const int i0 = static_cast<int>(std::floor(i)), j0 = static_cast<int>(std::floor(j));
  const double a = i - i0, b = j - j0;
  return (1 - b) * ((1 - a) * mapped(i0, j0) + a * mapped(i0 + 1, j0)) +
         b * ((1 - a) * mapped(i0, j0 + 1) + a * mapped(i0 + 1, j0 + 1));
}

Vec2 Lens::ideal_sample(int i, int j) const {
  if (!distorts()) return Vec2(i, j);
  const Vec2 pixel = camera_.focal_px * mapped(i, j) + camera_.centre_px;
  return {sample_of_pixel(pixel.x()), sample_of_pixel(pixel.y())};
}

Region Lens::ideal_samples(const Region& region) const {
  const int x0 = kSamplesPerPixel * region.x, x1 = kSamplesPerPixel * (region.x + region.width) - 1;
  const int y0 = kSamplesPerPixel * region.y, y1 = kSamplesPerPixel * (region.y + region.height) - 1;
  if (!distorts()) return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
  Eigen::AlignedBox2d box;
  // A lens moves the border of a region farther than its inside.
  for (int i = x0; i <= x1; ++i) {
    box.extend(ideal_sample(i, y0));
    box.extend(ideal_sample(i, y1));
  }
  for (int j = y0; j <= y1; ++j) {
    box.extend(ideal_sample(x0, j));
    box.extend(ideal_sample(x1, j));
  }
  const int left = static_cast<int>(std::floor(box.min().x())) - 1;
  const int top = static_cast<int>(std::floor(box.min().y())) - 1;
  return {left, top, static_cast<int>(std::ceil(box.max().x())) + 2 - left,
          static_cast<int>(std::ceil(box.max().y())) + 2 - top};
}

SampleGrid through_lens(const SampleGrid& ideal, const Lens& lens, const Region& samples) {
  SampleGrid seen{samples.x, samples.y, samples.width, samples.height, {}};
  seen.samples.resize(static_cast<std::size_t>(samples.width) * static_cast<std::size_t>(samples.height));
  for (int j = samples.y; j < samples.y + samples.height; ++j) {
    for (int i = samples.x; i < samples.x + samples.width; ++i) {
      const Vec2 at = lens.ideal_sample(i, j);
      const int i0 = std::clamp(static_cast<int>(std::floor(at.x())), ideal.x, ideal.x + ideal.width - 2);
      const int j0 = std::clamp(static_cast<int>(std::floor(at.y())), ideal.y, ideal.y + ideal.height - 2);
      const auto a = static_cast<float>(std::clamp(at.x() - i0, 0.0, 1.0));
      const auto b = static_cast<float>(std::clamp(at.y() - j0, 0.0, 1.0));
      const Sample &s00 = ideal.at(i0, j0), &s10 = ideal.at(i0 + 1, j0);
      const Sample &s01 = ideal.at(i0, j0 + 1), &s11 = ideal.at(i0 + 1, j0 + 1);
      const auto mix = [&](float Sample::*f) {
        return (1 - b) * ((1 - a) * s00.*f + a * s10.*f) + b * ((1 - a) * s01.*f + a * s11.*f);
      };
      const Sample& nearest = b < 0.5f ? (a < 0.5f ? s00 : s10) : (a < 0.5f ? s01 : s11);
      const bool one_surface = s00.owner == s10.owner && s00.owner == s01.owner && s00.owner == s11.owner;
      seen.at(i, j) = {mix(&Sample::laser), mix(&Sample::ambient),
                       one_surface ? mix(&Sample::depth) : nearest.depth, nearest.owner};
    }
  }
  return seen;
}

}  // namespace understudy::renderer
