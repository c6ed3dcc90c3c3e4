// A laser, a flat and a camera written out once more, without a line of the fit's: sensors that are drawn
// about the drawing, dots with noise, and what a mounting reads of a dot.
#pragma once

#include <cmath>
#include <vector>

#include "calibration/gap_sensor/gap_sensor_fit.h"
#include "core/random.h"

namespace understudy::calibration {

/// Plain numbers: a ray, a camera's centre and axes, a focal length.
struct PinholeSensor {
  Vec3 ray_from, ray_along, eye, right, down, ahead;
  double focal_px = 0;
  Vec2 centre_px;

  /// Of the flat z = slope . (x, y) - gap.
  Vec2 dot(const Vec2& slope, double gap) const {
    // (from + t along).z = slope . (from + t along).xy - gap
    const double t = (slope.dot(ray_from.head<2>()) - gap - ray_from.z()) /
                     (ray_along.z() - slope.dot(ray_along.head<2>()));
    const Vec3 seen = ray_from + t * ray_along - eye;
    return centre_px + focal_px / ahead.dot(seen) * Vec2(right.dot(seen), down.dot(seen));
  }

  /// The gap whose dot is nearest, by bisection of the distance's slope along the track.
  double read(const Vec2& slope, const Vec2& pixel) const {
    double low = -1e-3, high = 5e-3;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high), step = 1e-7;
      const Vec2 rate = dot(slope, middle + step) - dot(slope, middle - step);
      (rate.dot(pixel - dot(slope, middle)) > 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

inline PinholeSensor sensor_of(const machine::OpticsMounting& m, const Vec2& centre_px) {
  return {m.X_TL.translation(),   m.X_TL.linear().col(2), m.X_TC.translation(), m.X_TC.linear().col(0),
          m.X_TC.linear().col(1), m.X_TC.linear().col(2), m.focal_px,           centre_px};
}

/// The mounting displaced and turned by hand, freedom by freedom, to first order in the turns.
inline PinholeSensor displaced(const machine::OpticsMounting& drawn, const Vec2& centre_px,
                               const machine::MountingVector& e) {
  PinholeSensor s = sensor_of(drawn, centre_px);
  const Mat3 laser = drawn.X_TL.linear();
  s.ray_from += laser.col(0) * e[0] + laser.col(1) * e[1];
  s.ray_along = (s.ray_along + laser.col(0) * e[3] - laser.col(1) * e[2]).normalized();
  const Vec3 x = s.right, y = s.down, z = s.ahead;
  s.eye += x * e[4] + y * e[5] + z * e[6];
  const Vec3 turn = x * e[7] + y * e[8] + z * e[9];
  s.ahead = (z + turn.cross(z)).normalized();
  s.right = x + turn.cross(x);
  s.right = (s.right - s.ahead * s.ahead.dot(s.right)).normalized();
  s.down = s.ahead.cross(s.right);
  s.focal_px *= 1 + e[10];
  return s;
}

}  // namespace understudy::calibration
