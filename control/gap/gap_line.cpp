#include "control/gap/gap_line.h"

#include <algorithm>

namespace understudy::control {

void GapLine::begin(double time, double path) {
  *this = GapLine(options_);
  time_ = time;
  path_ = path;
  covariance_.slope = options_.slope_sigma * options_.slope_sigma;
}

void GapLine::set_height(double time, double path, double height, double variance) {
  time_ = time;
  path_ = path;
  height_ = height;
  covariance_.height = variance;
}

double GapLine::height_at(double path, double reach) const {
  return height_ + slope_ * std::max(0.0, std::min(path, reach) - path_);
}

double GapLine::variance_at(double time, double path) const {
  const double s = std::max(0.0, path - path_), dt = std::max(0.0, time - time_);
  return covariance_.height_ahead(s, options_.slope_walk) + options_.drift * options_.drift * dt;
}

void GapLine::predict(double time, double path, double reach) {
  const double s = std::max(0.0, path - path_), q = options_.slope_walk;
  height_ = height_at(path, reach);
  covariance_.height = variance_at(time, path);
  covariance_.both += s * covariance_.slope + q * s * s / 2;
  covariance_.slope += q * s;
  path_ = std::max(path_, path);
  time_ = std::max(time_, time);
}

void GapLine::correct(double innovation, double variance) {
  GapLineCovariance& p = covariance_;
  const double total = p.height + variance;
  const double k_height = p.height / total, k_slope = p.both / total;
  height_ += k_height * innovation;
  slope_ += k_slope * innovation;
  p.slope -= k_slope * p.both;
  p.both *= 1 - k_height;
  p.height *= 1 - k_height;
}

void GapLine::step(double by, double variance) {
  height_ += by;
  covariance_.height += variance;
}

}  // namespace understudy::control
