#include "control/gap/local_surface.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

constexpr double kReach = 20e-3;    // [m], from the tip along the axis
constexpr int kHalfGrid = 5;        // rays on an 11 x 11 grid, the corners outside the radius left out
constexpr double kHitShare = 0.75;  // of the rays: fewer, and the start lies at the part's edge
constexpr double kRoughness =
    25e-6;  // [m] RMS off the quadric: a quarter of the smallest gap that is accepted

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Where rays along the tool axis meet the part.
struct Samples {
  struct Sample {
    Vec2 p;    ///< in T
    double z;  ///< in T
  };
  std::array<Sample, std::size_t{2 * kHalfGrid + 1} * (2 * kHalfGrid + 1)> at;
  std::size_t count = 0, rays = 0;

  std::span<const Sample> hits() const { return std::span(at).first(count); }
  bool enough() const { return static_cast<double>(count) >= kHitShare * static_cast<double>(rays); }
};

std::string at_tip(const Pose& X_WT) {
  const Vec3 p = X_WT.translation();
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", to_mm(p.x()), to_mm(p.y()), to_mm(p.z()));
}

Samples sample_disc(const geometry::Mesh& part, const Pose& X_WT) {
  Samples samples;
  const Vec3 down = -tool_axis(X_WT);
  // From one radius above the tip the rays clear slopes up to 45 degrees and stay below overhangs farther up.
  for (int i = -kHalfGrid; i <= kHalfGrid; ++i)
    for (int j = -kHalfGrid; j <= kHalfGrid; ++j) {
      if (i * i + j * j > kHalfGrid * kHalfGrid) continue;
      ++samples.rays;
      const Vec2 p = kSurfaceRadius / kHalfGrid * Vec2(i, j);
      const auto hit = part.ray_hit(X_WT * Vec3(p.x(), p.y(), kSurfaceRadius), down, kSurfaceRadius + kReach);
      if (hit) samples.at[samples.count++] = {p, kSurfaceRadius - hit->distance};
    }
  return samples;
}

/// Lengths divided by the radius, so that all columns are of one size.
Vec6 monomials(const Vec2& p) {
  const double x = p.x() / kSurfaceRadius, y = p.y() / kSurfaceRadius;
  Vec6 m;
  m << 1, x, y, 0.5 * x * x, x * y, 0.5 * y * y;
  return m;
}

struct Fit {
  LocalSurface surface;
  double roughness = 0;  ///< [m] RMS
  bool smooth() const { return roughness < kRoughness; }
};

Fit fit_quadric(const Samples& samples) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Vec6 right = Vec6::Zero();
  for (const auto& s : samples.hits()) {
    const Vec6 m = monomials(s.p);
    normal += m * m.transpose();
    right += m * s.z;
  }
  const Vec6 fit = normal.ldlt().solve(right);
  double squares = 0;
  for (const auto& s : samples.hits()) squares += std::pow(s.z - monomials(s.p).dot(fit), 2);
  Fit result;
  result.roughness = std::sqrt(squares / static_cast<double>(samples.count));
  result.surface.slope = fit.segment<2>(1) / kSurfaceRadius;
  result.surface.curvature << fit[3], fit[4], fit[4], fit[5];
  result.surface.curvature /= kSurfaceRadius * kSurfaceRadius;
  return result;
}

}  // namespace

std::optional<double> height_over(const geometry::Mesh& part, const Pose& X_WT) {
  const auto hit = part.ray_hit(X_WT * Vec3(0, 0, kSurfaceRadius), -tool_axis(X_WT), kSurfaceRadius + kReach);
  if (!hit) return std::nullopt;
  return hit->distance - kSurfaceRadius;
}

std::optional<LocalSurface> find_local_surface(const geometry::Mesh& part, const Pose& X_WT) {
  if (!height_over(part, X_WT)) return std::nullopt;
  const Samples samples = sample_disc(part, X_WT);
  if (!samples.enough()) return std::nullopt;
  const Fit fit = fit_quadric(samples);
  if (!fit.smooth()) return std::nullopt;
  return fit.surface;
}

void make_ready(const geometry::Mesh& part) { static_cast<void>(part.nearest(Vec3::Zero())); }

LocalSurface local_surface(const geometry::Mesh& part, const Pose& X_WT) {
  if (!height_over(part, X_WT))
    throw InputError(fmt::format("the tool's axis does not meet the part within {:g} mm of the tip at {}",
                                 to_mm(kReach), at_tip(X_WT)));
  const Samples samples = sample_disc(part, X_WT);
  if (!samples.enough())
    throw InputError(
        fmt::format("the part ends within {:g} mm of the start at {}: {} of {} rays meet it, {:.0f} % are "
                    "needed to know its slope",
                    to_mm(kSurfaceRadius), at_tip(X_WT), samples.count, samples.rays, 100 * kHitShare));
  const Fit fit = fit_quadric(samples);
  if (!fit.smooth())
    throw InputError(
        fmt::format("the part within {:g} mm of the start at {} is {:.0f} um RMS off a smooth surface, "
                    "at most {:.0f} um can be sensed",
                    to_mm(kSurfaceRadius), at_tip(X_WT), to_um(fit.roughness), to_um(kRoughness)));
  return fit.surface;
}

}  // namespace understudy::control
