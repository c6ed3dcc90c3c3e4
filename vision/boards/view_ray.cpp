#include "vision/boards/view_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "vision/boards/view_ray_models.h"

namespace understudy::vision {
namespace {

constexpr double kEndless = 1e3;  // [m]

struct Segment {
  Vec3 start, direction;  // unit direction
  double low, high;       // [m] along it
};

/// The segments of a line with an endless one at either end.
std::vector<Segment> segments_of(const ViewRay& ray) {
  const std::vector<Vec3>& p = ray.points;
  const Vec3 chord = (p.back() - p.front()).normalized();
  std::vector<Segment> segments{{p.front(), chord, -kEndless, 0}, {p.back(), chord, 0, kEndless}};
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vec3 step = p[i + 1] - p[i];
    const double length = step.norm();
    if (length > 0) segments.push_back({p[i], step / length, 0, length});
  }
  return segments;
}

/// Closest points of two segments: the free optimum of one, clamped, answered by the other, twice.
std::pair<Vec3, Vec3> closest(const Segment& a, const Segment& b) {
  const Vec3 r = b.start - a.start;
  const double c = a.direction.dot(b.direction), ar = a.direction.dot(r), br = b.direction.dot(r);
  const double across = 1 - c * c;
  double s = across > 1e-12 ? (ar - c * br) / across : ar;
  s = std::clamp(s, a.low, a.high);
  const double t = std::clamp(s * c - br, b.low, b.high);
  s = std::clamp(t * c + ar, a.low, a.high);
  return {a.start + s * a.direction, b.start + t * b.direction};
}

double beyond_ends(const ViewRay& ray, const Vec3& p) {
  const Vec3 chord = ray.points.back() - ray.points.front();
  const double along = chord.normalized().dot(p - ray.points.front());
  return std::max({0.0, -along, along - chord.norm()});
}

void check(const CameraLayers& layers, const CalibrationUncertainty& uncertainty) {
  if (layers.layers.size() < 2) {
    throw InputError("camera calibration: " + std::to_string(layers.layers.size()) +
                     " layers with a chessboard, must be 2 or more");
  }
  for (std::size_t i = 0; i < layers.layers.size(); ++i) {
    const BoardLayer& layer = layers.layers[i];
    const bool finite = std::all_of(layer.corners_px.begin(), layer.corners_px.end(),
                                    [](const Vec2& p) { return p.allFinite(); });
    if (layer.corners_px.size() != static_cast<std::size_t>(layers.board.corners()) || !finite) {
      throw InputError("camera calibration: layer " + std::to_string(i) + " has " +
                       std::to_string(layer.corners_px.size()) + " corners" +
                       (finite ? "" : ", not all finite") + ", must be " +
                       std::to_string(layers.board.corners()));
    }
  }
  if (uncertainty.replicas < 0 || uncertainty.replicas > 10000) {
    throw InputError("camera calibration: " + std::to_string(uncertainty.replicas) +
                     " replicas, must be in 0..10000");
  }
}

}  // namespace

Approach closest_approach(const ViewRay& a, const ViewRay& b) {
  const std::vector<Segment> as = segments_of(a), bs = segments_of(b);
  double least = std::numeric_limits<double>::infinity();
  std::pair<Vec3, Vec3> best{Vec3::Zero(), Vec3::Zero()};
  for (const Segment& sa : as) {
    for (const Segment& sb : bs) {
      const auto pair = closest(sa, sb);
      const double gap = (pair.first - pair.second).squaredNorm();
      if (gap < least) least = gap, best = pair;
    }
  }
  const Vec3 middle = 0.5 * (best.first + best.second);
  return {middle, std::sqrt(least), std::max(beyond_ends(a, middle), beyond_ends(b, middle))};
}

const char* to_string(ViewRayMethod m) {
  switch (m) {
    case ViewRayMethod::layer_polyline:
      return "polyline";
    case ViewRayMethod::layer_line:
      return "line";
    case ViewRayMethod::pinhole:
      return "pinhole";
  }
  return "unknown";
}

std::shared_ptr<const ViewRayModel> calibrate_view_rays(ViewRayMethod method, const CameraLayers& layers,
                                                        const CalibrationUncertainty& uncertainty) {
  check(layers, uncertainty);
  if (method == ViewRayMethod::pinhole) return calibrate_pinhole(layers, uncertainty);
  return calibrate_layers(layers, uncertainty, method == ViewRayMethod::layer_line);
}

}  // namespace understudy::vision
