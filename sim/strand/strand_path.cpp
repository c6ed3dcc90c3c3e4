#include "sim/strand/strand_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/strand/strand_creep.h"
#include "sim/strand/strand_frame.h"

namespace understudy::sim {
namespace {

constexpr std::size_t kElementsMost = 1500;
constexpr double kSmallRotation = 0.3;  // [rad], cos and sin/x within 5 % of 1

void check(const AirPath& path, const PathOptions& options) {
  const std::size_t n = path.points_W.size();
  if (n < 2) throw InputError(fmt::format("strand: a path of {} points, must have 2 or more", n));
  if (n > kElementsMost)
    throw InputError(fmt::format("strand: a path of {} points, more than {}", n, kElementsMost));
  if (path.laid_at.size() != n)
    throw InputError(fmt::format("strand: {} times for {} points", path.laid_at.size(), n));
  if (!path.supported.empty() && path.supported.size() != n)
    throw InputError(fmt::format("strand: {} supports for {} points", path.supported.size(), n));
  for (std::size_t i = 0; i < n; ++i) {
    if (!path.points_W[i].allFinite() || !std::isfinite(path.laid_at[i]))
      throw InputError(fmt::format("strand: point {} is not finite", i + 1));
    if (i == 0) continue;
    if (!(path.laid_at[i] > path.laid_at[i - 1]))
      throw InputError(fmt::format("strand: point {} is laid at {} s, not after point {} at {} s", i + 1,
                                   path.laid_at[i], i, path.laid_at[i - 1]));
    const double length = (path.points_W[i] - path.points_W[i - 1]).norm();
    if (!(length >= 1e-7))
      throw InputError(fmt::format("strand: points {} and {} are {} mm apart, must be 0.0001 mm or more", i,
                                   i + 1, to_mm(length)));
  }
  if (!(path.diameter >= from_mm(0.01) && path.diameter <= from_mm(10)))
    throw InputError(fmt::format("strand: diameter is {} mm, outside 0.01 to 10 mm", to_mm(path.diameter)));
  if (options.elements_of_hot_length < 1 || options.cooling_steps < 4)
    throw InputError(
        fmt::format("strand: {} elements of the hot length and {} cooling steps, must be 1 and 4 or more",
                    options.elements_of_hot_length, options.cooling_steps));
}

/// The path with long stretches divided, and which of its points is which of the path's.
struct Division {
  std::vector<Vec3> points_W;
  std::vector<double> laid_at;
  std::vector<std::size_t> node_of_point;
  std::vector<double> middle_at;  // [s], when the nozzle passes the middle of each element
};

Division divide(const AirPath& path, double time_to_solid, const PathOptions& options) {
  const std::size_t stretches = path.points_W.size() - 1;
  const double total = path.laid_at.back() - path.laid_at.front();
  const double longest = std::max(time_to_solid / options.elements_of_hot_length,
                                  total / static_cast<double>(kElementsMost - stretches + 1));
  Division d;
  d.points_W.push_back(path.points_W.front());
  d.laid_at.push_back(path.laid_at.front());
  d.node_of_point.push_back(0);
  for (std::size_t i = 0; i < stretches; ++i) {
    const double time = path.laid_at[i + 1] - path.laid_at[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(time / longest - 1e-9)));
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      d.points_W.push_back((1 - share) * path.points_W[i] + share * path.points_W[i + 1]);
      const double before = d.laid_at.back();
      d.laid_at.push_back(path.laid_at[i] + share * time);
      d.middle_at.push_back(0.5 * (before + d.laid_at.back()));
    }
    d.node_of_point.push_back(d.points_W.size() - 1);
  }
  return d;
}

class Drawing {
 public:
  Drawing(StrandFrame& frame, const StrandCreep& creep, const Division& division)
      : frame_(frame), creep_(creep), division_(division), time_(division.middle_at.front()) {}

  void move_to(double time) {
    if (!(time > time_)) return;
    now_.resize(frame_.elements());
    for (std::size_t i = 0; i < now_.size(); ++i)
      now_[i] = creep_.between(time_ - division_.middle_at[i], time - division_.middle_at[i]);
    frame_.step(now_);
    time_ = time;
  }
  /// In equal steps of at most `longest`.
  void move_to(double time, double longest) {
    const double from = time_;
    const int parts = std::max(1, static_cast<int>(std::ceil((time - from) / longest)));
    for (int k = 1; k <= parts; ++k) move_to(from + (time - from) * k / parts);
  }

 private:
  StrandFrame& frame_;
  const StrandCreep& creep_;
  const Division& division_;
  double time_;
  std::vector<double> now_;
};

double farthest(const StrandFrame& frame, const Division& division) {
  double far = 0;
  for (const std::size_t node : division.node_of_point)
    far = std::max(far, frame.displacement_W(node).norm());
  return far;
}

void read_shape(const StrandFrame& frame, const Division& division, PathSag& result) {
  for (const std::size_t node : division.node_of_point) {
    const Vec3& moved = frame.displacement_W(node);
    result.displacement_W.push_back(moved);
    result.drop_max = std::max(result.drop_max, -moved.z());
    if (moved.norm() <= result.sag_max) continue;
    result.sag_max = moved.norm();
    result.sag_max_point = result.displacement_W.size() - 1;
  }
  for (std::size_t i = 0; i <= frame.elements(); ++i)
    result.rotation_max = std::max(result.rotation_max, frame.rotation_W(i).norm());
  result.small = result.rotation_max < kSmallRotation;
}

StrandFrame::Section section_of(const machine::Material& material, double diameter) {
  const double weight = material.density * std::numbers::pi / 4 * diameter * diameter * kGravity;
  return {diameter, material.youngs_modulus, material.youngs_modulus / (2 + 2 * material.poisson_ratio),
          Vec3(0, 0, -weight)};
}

}  // namespace

PathSag compute_sag(const machine::Material& material, const AirPath& path, const PathOptions& options) {
  check(path, options);
  const double start = path.nozzle_temperature > 0 ? path.nozzle_temperature : material.nozzle_temperature;
  machine::check_nozzle_temperature(material, start);
  const StrandCreep creep(material, path.diameter, start, path.surroundings);
  const Division division = divide(path, creep.time_to_solid(), options);

  PathSag result;
  result.time_to_solid = creep.time_to_solid();
  result.solid_at = path.laid_at.back() + result.time_to_solid;
  const double longest = result.time_to_solid / options.cooling_steps;
  StrandFrame frame(section_of(material, path.diameter), division.points_W.front());
  Drawing drawing(frame, creep, division);
  std::size_t point = 1;
  for (std::size_t i = 0; i < division.middle_at.size(); ++i) {
    if (i > 0) drawing.move_to(division.middle_at[i], longest);
    frame.append(division.points_W[i + 1]);
    if (i + 1 != division.node_of_point[point]) continue;
    if (!path.supported.empty() && path.supported[point]) frame.support(i + 1);
    ++point;
  }
  drawing.move_to(division.laid_at.back(), longest);
  result.sag_at_end = farthest(frame, division);
  frame.hold_end(path.end_supported);
  for (int k = 1; k <= options.cooling_steps; ++k)
    drawing.move_to(division.laid_at.back() +
                    creep.time_at_share(static_cast<double>(k) / options.cooling_steps));
  // The last section is the warmest by half of its own time, and what is solid swings into its elastic place.
  drawing.move_to(result.solid_at);
  read_shape(frame, division, result);
  return result;
}

}  // namespace understudy::sim
