// The arrangement of docs/reference.md#dot-and-gap: camera 45 degrees, laser 40 degrees, azimuths 90 degrees
// apart, 64 px/mm, spot of 0.15 mm; the beam crosses the tip plane 1.1 mm beside the nozzle.
#pragma once

#include "core/units.h"
#include "renderer/laser_view.h"

namespace understudy::renderer {

/// Looks along `sight` from `distance` before `target`, horizontal `right`.
inline Pose looking(const Vec3& target, const Vec3& sight, const Vec3& right, double distance) {
  Mat3 R;
  R << right, sight.cross(right), sight;
  return make_pose(R, Vec3(target - distance * sight));
}

inline LaserScene reference_scene() {
  LaserScene s;
  const double laser = from_deg(40), view = from_deg(45);
  s.X_TL = looking({0, 1.1e-3, 0}, {0, -std::sin(laser), -std::cos(laser)}, {-1, 0, 0}, 28e-3);
  s.X_TC = looking({0, 0.5e-3, 0}, {-std::sin(view), 0, -std::cos(view)}, {0, 1, 0}, 33e-3);
  s.camera = {.width = 640, .height = 480, .focal_px = 64 * 33, .centre_px = {319.5, 239.5}};
  s.tool_bodies = {{"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}}};
  s.waist_diameter = 0.15e-3;
  s.wavelength = 650e-9;
  s.peak_level = 150;
  s.ambient_level = 12;
  s.aperture_sine = 0.05;
  s.blur_px = 0.7;
  s.full_well = 10000;
  s.read_noise = 10;
  s.X_WT = make_pose(Quat::Identity(), Vec3(3e-3, -2e-3, 0.5e-3));
  return s;
}

inline LaserScene clean_scene() {
  LaserScene s = reference_scene();
  s.speckle = false;
  s.noise = false;
  return s;
}

constexpr Region kSensor{0, 0, 640, 480};

/// Sixty-four pixels on each side of a pixel.
inline Region around(const Vec2& pixel) {
  return {static_cast<int>(pixel.x()) - 64, static_cast<int>(pixel.y()) - 64, 128, 128};
}

/// Flux, centroid and second moments of what is brighter than `floor`.
struct Moments {
  double flux = 0;
  Vec2 centre{0, 0};
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
};

inline Moments moments(const Image& image, double floor) {
  Moments m;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double light = std::max(0.0, image.at(x, y) - floor);
      const Vec2 p(x + image.region.x, y + image.region.y);
      m.flux += light;
      m.centre += light * p;
      second += light * p * p.transpose();
    }
  }
  m.centre /= m.flux;
  m.spread = second / m.flux - m.centre * m.centre.transpose();
  return m;
}

}  // namespace understudy::renderer
