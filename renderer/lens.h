// The grid of light samples, two by two in a pixel, and where each of them looks.
#pragma once

#include <vector>

#include "core/image.h"

namespace understudy::renderer {

constexpr int kSamplesPerPixel = 2;  // along each axis

struct Sample {
  float laser = 0;    ///< [grey levels]
  float ambient = 0;  ///< [grey levels]
  float depth = 0;    ///< [m], along the camera's axis
  float owner = 0;    ///< see Owner
};

enum class Owner { nothing, scenery, tool };  // scenery rests in W: table and part
inline Owner owner_of(const Sample& s) { return static_cast<Owner>(static_cast<int>(s.owner)); }

/// Sample (i, j) lies at pixel ((i + 1/2) / 2 - 1/2, ...); indices may be negative outside the sensor.
struct SampleGrid {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<Sample> samples;

  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j - y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(i - x);
  }
  Sample& at(int i, int j) { return samples[index(i, j)]; }
  const Sample& at(int i, int j) const { return samples[index(i, j)]; }
};

inline double pixel_of_sample(double i) { return (i + 0.5) / kSamplesPerPixel - 0.5; }
inline double sample_of_pixel(double u) { return (u + 0.5) * kSamplesPerPixel - 0.5; }

/// Knows the ideal (undistorted) viewing ray of each pixel of the sensor and of `margin` pixels around it.
class Lens {
 public:
  Lens(const Camera& camera, int margin);

  const Camera& camera() const { return camera_; }
  int margin() const { return margin_; }
  bool distorts() const { return !ideal_.empty(); }
  /// Whether it was made from this camera and margin.
  bool matches(const Camera& camera, int margin) const;

  /// Viewing ray (x, y, 1) of a position on the grid, distortion removed.
  Vec2 ray(double i, double j) const;
  /// Where an undistorting pinhole with the same focal length and centre has that ray, as sample indices.
  Vec2 ideal_sample(int i, int j) const;
  /// Samples of the ideal pinhole that cover the pixels of `region` (which may reach into the margin).
  Region ideal_samples(const Region& region) const;

 private:
  Vec2 mapped(int i, int j) const;

  Camera camera_;
  int margin_;
  int width_ = 0, height_ = 0;  // samples of the map
  std::vector<Vec2> ideal_;     // rays; empty without distortion
};

/// The pinhole's picture seen through the lens: resampled at the distorted positions.
SampleGrid through_lens(const SampleGrid& ideal, const Lens& lens, const Region& samples);

}  // namespace understudy::renderer
