#include "sim/removal/surface_samples.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "geometry/normals.h"

namespace understudy::sim {
namespace {

using Corners = std::array<Vec3, 3>;

int parts_of(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
}

/// False: there are too many.
bool divide(const Corners& corners, double spacing, std::vector<SurfaceSample>& samples) {
  std::size_t tip = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const auto opposite = [&](std::size_t i) { return (corners[(i + 2) % 3] - corners[(i + 1) % 3]).norm(); };
    if (opposite(k) < opposite(tip)) tip = k;
  }
  const Vec3 &a = corners[tip], &b = corners[(tip + 1) % 3], &c = corners[(tip + 2) % 3];
  const int strips = parts_of(std::max((b - a).norm(), (c - a).norm()), spacing);
  // Between the sides from the tip, at shares of their lengths.
  const auto at = [&](double along, double across) { return Vec3(a + along * (b - a + across * (c - b))); };
  for (int i = 0; i < strips; ++i) {
    const double low = static_cast<double>(i) / strips, high = (i + 1.0) / strips;
    const int cells = parts_of(high * (c - b).norm(), spacing);
    for (int j = 0; j < cells; ++j) {
      const double left = static_cast<double>(j) / cells, right = (j + 1.0) / cells;
      SurfaceSample sample;
      sample.corners = {at(low, left), at(high, left), at(high, right), at(low, right)};
      sample.area =
          0.5 * ((sample.corners[2] - sample.corners[0]).cross(sample.corners[3] - sample.corners[1])).norm();
      sample.position = at((low + high) / 2, (left + right) / 2);
      samples.push_back(sample);
    }
    if (samples.size() > kMostSamples) return false;
  }
  return true;
}

bool is_foot(const geometry::Mesh& part, const Corners& corners, const Vec3& normal) {
  constexpr double kFlat = 1e-6;  // [m] and [1]
  for (const Vec3& p : corners)
    if (p.z() > part.lower().z() + kFlat) return false;
  return normal.z() < -1 + kFlat;
}

bool sample_all(const geometry::Mesh& part, double spacing, std::vector<SurfaceSample>& samples) {
  samples.clear();
  for (const auto& t : part.triangles()) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = part.vertices()[static_cast<std::size_t>(t[k])];
    const Vec3 normal = geometry::face_normal(corners[0], corners[1], corners[2]);
    if (normal.isZero() || is_foot(part, corners, normal)) continue;
    if (!divide(corners, spacing, samples)) return false;
  }
  return true;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const geometry::Mesh& part, double& spacing) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw InputError(fmt::format("samples {:g} mm apart, it must be above 0", to_mm(spacing)));
  std::vector<SurfaceSample> samples;
  while (!sample_all(part, spacing, samples)) spacing *= 2;
  for (SurfaceSample& sample : samples) sample.normal = part.nearest(sample.position).normal;
  return samples;
}

}  // namespace understudy::sim
