#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "control/gap/gap_reading.h"
#include "core/error.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::control {
namespace {

constexpr double kReach = 20e-3;    // [m], from the tip along the axis
constexpr int kHalfGrid = 5;        // rays on an 11 x 11 grid, the corners outside the radius left out
constexpr double kHitShare = 0.75;  // of the rays: fewer, and the start lies at the part's edge
constexpr double kRoughness =
    25e-6;  // [m] RMS off the quadric: a quarter of the smallest gap that is accepted

using Vec6 = Eigen::Matrix<double, 6, 1>;

struct Sample {
  Vec2 p;    ///< in T
  double z;  ///< in T
};

std::string at_tip(const Pose& X_WT) {
  const Vec3 p = X_WT.translation();
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", to_mm(p.x()), to_mm(p.y()), to_mm(p.z()));
}

std::vector<Sample> sample_disc(const geometry::Mesh& part, const Pose& X_WT, double radius, int& rays) {
  std::vector<Sample> samples;
  rays = 0;
  const Vec3 down = -tool_axis(X_WT);
  // From one radius above the tip the rays clear slopes up to 45 degrees and stay below overhangs farther up.
  for (int i = -kHalfGrid; i <= kHalfGrid; ++i)
    for (int j = -kHalfGrid; j <= kHalfGrid; ++j) {
      if (i * i + j * j > kHalfGrid * kHalfGrid) continue;
      ++rays;
      const Vec2 p = radius / kHalfGrid * Vec2(i, j);
      const auto hit = part.ray_hit(X_WT * Vec3(p.x(), p.y(), radius), down, radius + kReach);
      if (hit) samples.push_back({p, radius - hit->distance});
    }
  return samples;
}

/// Lengths divided by the radius, so that all columns are of one size.
Vec6 monomials(const Vec2& p, double radius) {
  const double x = p.x() / radius, y = p.y() / radius;
  Vec6 m;
  m << 1, x, y, 0.5 * x * x, x * y, 0.5 * y * y;
  return m;
}

}  // namespace

std::optional<double> height_over(const geometry::Mesh& part, const Pose& X_WT, double radius) {
  const auto hit = part.ray_hit(X_WT * Vec3(0, 0, radius), -tool_axis(X_WT), radius + kReach);
  if (!hit) return std::nullopt;
  return hit->distance - radius;
}

LocalSurface local_surface(const geometry::Mesh& part, const Pose& X_WT, double radius) {
  if (!height_over(part, X_WT, radius))
    throw InputError(fmt::format("the tool's axis does not meet the part within {:g} mm of the tip at {}",
                                 to_mm(kReach), at_tip(X_WT)));
  int rays = 0;
  const std::vector<Sample> samples = sample_disc(part, X_WT, radius, rays);
  if (static_cast<double>(samples.size()) < kHitShare * rays)
    throw InputError(
        fmt::format("the part ends within {:g} mm of the start at {}: {} of {} rays meet it, {:.0f} % are "
                    "needed to know its slope",
                    to_mm(radius), at_tip(X_WT), samples.size(), rays, 100 * kHitShare));
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Vec6 right = Vec6::Zero();
  for (const Sample& s : samples) {
    const Vec6 m = monomials(s.p, radius);
    normal += m * m.transpose();
    right += m * s.z;
  }
  const Vec6 fit = normal.ldlt().solve(right);
  double squares = 0;
  for (const Sample& s : samples) squares += std::pow(s.z - monomials(s.p, radius).dot(fit), 2);
  const double roughness = std::sqrt(squares / static_cast<double>(samples.size()));
  if (!(roughness < kRoughness))
    throw InputError(
        fmt::format("the part within {:g} mm of the start at {} is {:.0f} um RMS off a smooth surface, "
                    "at most {:.0f} um can be sensed",
                    to_mm(radius), at_tip(X_WT), to_um(roughness), to_um(kRoughness)));
  LocalSurface surface;
  surface.slope = fit.segment<2>(1) / radius;
  surface.curvature << fit[3], fit[4], fit[4], fit[5];
  surface.curvature /= radius * radius;
  return surface;
}

}  // namespace understudy::control
