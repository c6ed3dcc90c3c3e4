#include "sim/surface/deviation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/random.h"
#include "core/units.h"
#include "geometry/normals.h"

namespace understudy::sim {
namespace {

constexpr int kSamplesMax = 10'000'000;
constexpr double kOffSurface = 1e-6;  // [m], to leave the triangle a ray starts on

// A piece of a triangle that lies in the region, its area and all before it.
struct Piece {
  Vec3 a, b, c, normal;
  double up_to = 0;
};

// Of a convex polygon what is not above `limit` along an axis; `sign` -1: not below.
std::vector<Vec3> clip(const std::vector<Vec3>& polygon, Eigen::Index axis, double limit, double sign) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double over_p = sign * (p[axis] - limit), over_q = sign * (q[axis] - limit);
    if (over_p <= 0) kept.push_back(p);
    if ((over_p < 0 && over_q > 0) || (over_p > 0 && over_q < 0))
      kept.push_back(p + over_p / (over_p - over_q) * (q - p));
  }
  return kept;
}

std::vector<Piece> pieces_of(const geometry::Mesh& intended,
                             const std::optional<Eigen::AlignedBox3d>& region) {
  std::vector<Piece> pieces;
  double sum = 0;
  for (const auto& triangle : intended.triangles()) {
    std::vector<Vec3> polygon;
    for (const int v : triangle) polygon.push_back(intended.vertices()[v]);
    const Vec3 normal = geometry::face_normal(polygon[0], polygon[1], polygon[2]);
    if (normal.isZero(0)) continue;
    for (Eigen::Index axis = 0; region && axis < 3; ++axis) {
      polygon = clip(polygon, axis, region->max()[axis], 1);
      polygon = clip(polygon, axis, region->min()[axis], -1);
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      const double area = 0.5 * (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]).norm();
      if (!(area > 0)) continue;
      pieces.push_back({polygon[0], polygon[k - 1], polygon[k], normal, sum += area});
    }
  }
  if (pieces.empty()) throw InputError("the deviation's region holds nothing of the intended surface");
  return pieces;
}

void check(const DeviationSettings& settings) {
  if (settings.samples < 1 || settings.samples > kSamplesMax)
    throw InputError(
        fmt::format("the deviation has {} samples, not from 1 to {}", settings.samples, kSamplesMax));
  if (!(settings.limit > 0 && std::isfinite(settings.limit)))
    throw InputError(fmt::format("the deviation's limit is {:.6g} mm, not above 0", to_mm(settings.limit)));
  if (settings.region_W && settings.region_W->isEmpty())
    throw InputError("the deviation's region is empty: its lower corner is above its upper one");
}

// One draw from each of as many equal parts of the area as samples are wanted.
std::vector<DeviationSample> spread(const geometry::Mesh& intended, const DeviationSettings& settings) {
  const std::vector<Piece> pieces = pieces_of(intended, settings.region_W);
  std::vector<DeviationSample> samples(static_cast<std::size_t>(settings.samples));
  Random random(settings.seed, "deviation");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double share = (static_cast<double>(i) + random.uniform()) / settings.samples;
    const Piece& p = *std::upper_bound(pieces.begin(), pieces.end() - 1, share * pieces.back().up_to,
                                       [](double area, const Piece& piece) { return area < piece.up_to; });
    const double root = std::sqrt(random.uniform()), v = random.uniform();
    samples[i].place_W = (1 - root) * p.a + root * (1 - v) * p.b + root * v * p.c;
    samples[i].normal_W = p.normal;
  }
  return samples;
}

void measure(const BeadIndex& beads, const geometry::Mesh& intended, double limit, DeviationSample& sample) {
  // Nothing in front of the surface belongs to the wall opposite.
  const auto opposite =
      intended.ray_hit(sample.place_W + kOffSurface * sample.normal_W, sample.normal_W, 2 * limit);
  const double outside = opposite ? std::min(limit, 0.5 * (opposite->distance + kOffSurface)) : limit;
  const auto hit =
      beads.ray_hit(sample.place_W + outside * sample.normal_W, -sample.normal_W, outside + limit);
  if (hit) sample.along = outside - hit->distance;
  if (const auto near = beads.nearest_surface(sample.place_W, limit)) sample.nearest = near->distance;
}

// Nearest rank: the least magnitude that so many of them do not exceed. Not core/quantile, which
// interpolates: of a few samples a share of exactly so many must lie within the figure.
double percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

std::vector<DeviationSample> sample_deviation(const BeadIndex& beads, const geometry::Mesh& intended,
                                              const DeviationSettings& settings) {
  check(settings);
  std::vector<DeviationSample> samples = spread(intended, settings);
  for (DeviationSample& sample : samples) {
    stop_if_interrupted();
    measure(beads, intended, settings.limit, sample);
  }
  return samples;
}

SurfaceDeviation summarise(const std::vector<DeviationSample>& samples) {
  SurfaceDeviation result;
  result.samples = samples.size();
  std::vector<double> along, nearest;
  double sum = 0;
  for (const DeviationSample& sample : samples) {
    if (sample.nearest) nearest.push_back(std::abs(*sample.nearest));
    if (!sample.along) continue;
    along.push_back(std::abs(*sample.along));
    sum += *sample.along;
  }
  std::sort(along.begin(), along.end());
  std::sort(nearest.begin(), nearest.end());
  result.covered = along.size();
  if (!nearest.empty()) result.nearest_p95 = percentile(nearest, 0.95);
  if (along.empty()) return result;
  const auto count = static_cast<double>(along.size());
  result.coverage = count / static_cast<double>(samples.size());
  result.mean = sum / count;
  result.p50 = percentile(along, 0.5);
  result.p95 = percentile(along, 0.95);
  result.largest = along.back();
  return result;
}

}  // namespace understudy::sim
