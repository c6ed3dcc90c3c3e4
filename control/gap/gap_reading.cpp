#include "control/gap/gap_reading.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "control/gap/confidence.h"

namespace understudy::control {
namespace {

constexpr double kGapLow = -1e-3, kGapHigh = 8e-3;  // [m], in which a dot is explained
constexpr int kIterations = 20;                     // Newton needs 4; the track is nearly straight
constexpr double kConverged = 1e-11;                // [m], 1e-5 of the best reading's sigma

struct Track {
  Vec2 pixel{0, 0};
  Vec2 rate{0, 0};  ///< [px/m], by the gap
};

double height(const LocalSurface& surface, const Vec2& p) {
  return surface.slope.dot(p) + 0.5 * p.dot(surface.curvature * p);
}

/// Where the beam meets the surface at a gap, and how fast that point moves along the beam.
struct Hit {
  Vec3 p_T{0, 0, 0};
  Vec3 rate{0, 0, 0};  ///< [m/m]
};

bool beam_hit(const machine::Laser& laser, const LocalSurface& surface, double gap, Hit& hit) {
  const Vec3 b = laser.X_TL.linear().col(2);
  if (!(b.z() < 0)) return false;
  // From where the beam crosses the tip plane, so that roots are small and keep their digits.
  const Vec3 o = laser.X_TL.translation() - laser.X_TL.translation().z() / b.z() * b;
  const Vec2 o2 = o.head<2>(), b2 = b.head<2>();
  // F(t) = height above the surface = c0 + c1 t + c2 t^2; from outside the beam enters where F falls.
  const double c0 = o.z() - height(surface, o2) + gap;
  const double c1 = b.z() - surface.slope.dot(b2) - o2.dot(surface.curvature * b2);
  const double c2 = -0.5 * b2.dot(surface.curvature * b2);
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (!(discriminant > 0)) return false;
  const double fall = std::sqrt(discriminant);  // -dF/dt at that root
  const double t = 2 * c0 / (fall - c1);
  if (!std::isfinite(t)) return false;
  hit.p_T = o + t * b;
  hit.rate = b / fall;
  return true;
}

bool track_at(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
              Track& track) {
  Hit hit;
  if (!beam_hit(machine.laser, surface, gap, hit)) return false;
  const Camera& camera = machine.microscope.camera;
  const Pose X_CT = machine.microscope.X_TC.inverse();
  constexpr double kStep = 1e-6;  // [m]; the central difference errs by its square times the lens's curvature
  const auto pixel = camera.project(X_CT * hit.p_T);
  const auto ahead = camera.project(X_CT * Vec3(hit.p_T + kStep * hit.rate));
  const auto behind = camera.project(X_CT * Vec3(hit.p_T - kStep * hit.rate));
  if (!pixel || !ahead || !behind) return false;
  track.pixel = *pixel;
  track.rate = (*ahead - *behind) / (2 * kStep);
  return true;
}

/// Inverse of the dot's covariance; of one pixel in every direction when that tells nothing.
Eigen::Matrix2d information(const Eigen::Matrix2d& covariance) {
  const bool usable = covariance.allFinite() && covariance(0, 0) > 0 && covariance.determinant() > 0;
  return usable ? Eigen::Matrix2d(covariance.inverse()) : Eigen::Matrix2d(Eigen::Matrix2d::Identity());
}

/// Smallest ratio, over directions, of two second moments; 0 where one of them is none.
double narrowest(const Eigen::Matrix2d& seen, const Eigen::Matrix2d& whole) {
  const Eigen::LLT<Eigen::Matrix2d> root(whole);
  if (root.info() != Eigen::Success || !seen.allFinite()) return 0;
  const Eigen::Matrix2d half = root.matrixL().solve(seen);
  const Eigen::Matrix2d ratio = root.matrixL().solve(half.transpose());
  const double mean = 0.5 * ratio.trace();
  return mean - std::sqrt(std::max(0.0, mean * mean - ratio.determinant()));
}

/// Of a second moment, a share of it, that the calibrated waist leaves: twice that of the waist.
double spread_sigma(const machine::MachineDescription& machine) {
  if (!machine.gap_sensor || !machine.gap_sensor->waist) return 0;
  return 2 * machine.gap_sensor->waist->sigma / machine.laser.waist_diameter;
}

/// The gap, of a few over the range, whose dot is nearest: where Newton begins.
bool nearest_on_grid(const machine::MachineDescription& machine, const LocalSurface& surface,
                     const Vec2& pixel, double& gap) {
  constexpr int kPoints = 19;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPoints; ++i) {
    const double candidate = kGapLow + (kGapHigh - kGapLow) * i / (kPoints - 1);
    Track track;
    if (!track_at(machine, surface, candidate, track)) continue;
    const double distance = (track.pixel - pixel).norm();
    if (distance < best) {
      best = distance;
      gap = candidate;
    }
  }
  return std::isfinite(best);
}

}  // namespace

bool dot_pixel(const machine::Laser& laser, const machine::Microscope& microscope,
               const LocalSurface& surface, double gap, Vec2& pixel) {
  Hit hit;
  if (!beam_hit(laser, surface, gap, hit)) return false;
  const auto seen = microscope.camera.project(microscope.X_TC.inverse() * hit.p_T);
  if (seen) pixel = *seen;
  return seen.has_value();
}

bool predict_dot(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                 Vec2& pixel) {
  Track track;
  if (!track_at(machine, surface, gap, track)) return false;
  pixel = track.pixel;
  const Camera& camera = machine.microscope.camera;
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width - 1 && pixel.y() <= camera.height - 1;
}

bool dot_place(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
               Vec3& p_T) {
  Hit hit;
  if (!beam_hit(machine.laser, surface, gap, hit)) return false;
  p_T = hit.p_T;
  return true;
}

bool predict_spread(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                    Eigen::Matrix2d& spread_px2) {
  const double sigma = machine.laser.waist_diameter / 4;  // of a beam whose 1/e^2 diameter is the waist's
  Eigen::Matrix2d across;
  for (int i = 0; i < 2; ++i) {
    std::array<Vec2, 2> pixel;
    for (std::size_t side = 0; side < 2; ++side) {
      machine::Laser ray = machine.laser;
      ray.X_TL.translation() += (side == 0 ? -sigma : sigma) * ray.X_TL.linear().col(i);
      Hit hit;
      if (!beam_hit(ray, surface, gap, hit)) return false;
      const auto seen = machine.microscope.camera.project(machine.microscope.X_TC.inverse() * hit.p_T);
      if (!seen) return false;
      pixel[side] = *seen;
    }
    across.col(i) = 0.5 * (pixel[1] - pixel[0]);
  }
  constexpr double kPixel = 1.0 / 12;  // [px^2], of a pixel's own square
  const double blur = machine.microscope.blur_px;
  spread_px2 = across * across.transpose() + (blur * blur + kPixel) * Eigen::Matrix2d::Identity();
  return true;
}

bool read_gap(const machine::MachineDescription& machine, const LocalSurface& surface,
              const vision::DotMeasurement& dot, GapReading& reading) {
  if (!dot.position_px.allFinite()) return false;
  const Eigen::Matrix2d weight = information(dot.covariance_px2);
  double gap = 0;
  if (!nearest_on_grid(machine, surface, dot.position_px, gap)) return false;
  for (int i = 0; i < kIterations; ++i) {
    Track track;
    if (!track_at(machine, surface, gap, track)) return false;
    const Vec2 miss = dot.position_px - track.pixel;
    const double gain = track.rate.dot(weight * track.rate);
    if (!(gain > 0)) return false;
    const double change = track.rate.dot(weight * miss) / gain;
    if (std::abs(change) < kConverged) {
      const Vec2 along = track.rate.normalized();
      reading = {gap, 1 / std::sqrt(gain), std::abs(along.x() * miss.y() - along.y() * miss.x()), 0,
                 spread_sigma(machine)};
      Eigen::Matrix2d whole;
      if (predict_spread(machine, surface, gap, whole)) reading.narrowest = narrowest(dot.spread_px2, whole);
      return gap >= kGapLow && gap <= kGapHigh;
    }
    // A little beyond the range is allowed on the way: the answer is judged, not the path to it.
    gap = std::clamp(gap + change, 2 * kGapLow, 1.5 * kGapHigh);
  }
  return false;
}

bool whole(const GapReading& reading, const vision::DotMeasurement& dot) {
  constexpr double kUnmodelled = 0.05;  // the camera's rounding, a blur that is off by a fifth, facets
  const double sigma = std::hypot(dot.spread_sigma, reading.whole_sigma);
  return reading.narrowest >= 1 - kPlausibleSigmas * sigma - kUnmodelled;
}

Region region_for_gap(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                      double below, double above, int margin_px) {
  const Camera& camera = machine.microscope.camera;
  const Region sensor = camera.sensor();
  Eigen::AlignedBox2d box;
  constexpr int kPoints = 5;  // the track bends by less than the margin between them
  for (int i = 0; i < kPoints; ++i) {
    Track track;
    if (!track_at(machine, surface, gap - below + (below + above) * i / (kPoints - 1), track)) return sensor;
    box.extend(track.pixel);
  }
  const auto clip = [](double v, int size) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(size)));
  };
  Region region;
  region.x = clip(std::floor(box.min().x()) - margin_px, camera.width);
  region.y = clip(std::floor(box.min().y()) - margin_px, camera.height);
  region.width = clip(std::ceil(box.max().x()) + margin_px + 1, camera.width) - region.x;
  region.height = clip(std::ceil(box.max().y()) + margin_px + 1, camera.height) - region.y;
  return region.width > 0 && region.height > 0 ? region : sensor;
}

}  // namespace understudy::control
