// The gap that there would be without any correction, as a line over the path: its height and its slope, by a
// Kalman filter. The slope walks over the path, and the height with time.
#pragma once

#include "machine/control_settings.h"

namespace understudy::control {

using GapLineOptions = machine::GapLineSettings;

/// Of a line's height [m] and slope [m/m].
struct GapLineCovariance {
  double height = 0;  ///< [m^2]
  double both = 0;    ///< [m]
  double slope = 0;
  /// [m^2], of the height `s` [m] farther along the path.
  double height_ahead(double s, double slope_walk) const {
    return height + s * (2 * both + s * slope) + slope_walk * s * s * s / 3;
  }
};

class GapLine {
 public:
  explicit GapLine(const GapLineOptions& options) : options_(options) {}

  /// Nothing is known but where it begins.
  void begin(double time, double path);
  /// The height there [m] and its variance [m^2]; the slope's is as it was.
  void set_height(double time, double path, double height, double variance);
  /// To a later time [s] and place [m]; its slope is believed as far as `reach` [m].
  void predict(double time, double path, double reach);
  /// By a reading of the height that is off by `innovation` [m].
  void correct(double innovation, double variance);
  /// The machine has made a lasting step [m] of its own.
  void step(double by, double variance);

  double height() const { return height_; }  ///< [m], at path()
  double slope() const { return slope_; }    ///< [m/m]
  double path() const { return path_; }      ///< [m], of the last reading
  /// [m], at a place; the slope is believed as far as `reach`.
  double height_at(double path, double reach) const;
  double variance_at(double time, double path) const;  ///< [m^2], of it then
  const GapLineCovariance& covariance() const { return covariance_; }

 private:
  GapLineOptions options_;
  double time_ = 0, path_ = 0;
  double height_ = 0, slope_ = 0;
  GapLineCovariance covariance_;
};

}  // namespace understudy::control
